#include "plumb/report/evaluation.hpp"

#include <cmath>
#include <numbers>

#include "plumb/data/io/file_text.hpp"
#include "plumb/data/io/frame_files.hpp"
#include "plumb/data/io/trajectory_file.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;

/// The files that frames.txt lists, or else those in frames/, by name.
std::vector<fs::path> frames_of(const fs::path& sequence) {
  std::vector<fs::path> frames;
  if (const auto list = sequence / "frames.txt"; fs::exists(list)) {
    const io::FileBytes bytes(list);
    io::Lines lines(bytes.view());
    for (std::string_view line; lines.next(line);) {
      const auto first = line.find_first_not_of(" \t");
      if (first == std::string_view::npos || line[first] == '#') continue;
      line = line.substr(first, line.find_last_not_of(" \t") + 1 - first);
      frames.push_back((sequence / line).lexically_normal());
    }
    return frames;
  }
  for (auto& file : io::files_in(sequence / "frames", {".pcd", ".ply"}))
    frames.push_back(std::move(file.path));
  return frames;
}

TrajectoryScore score(const fs::path& file, const Trajectory& truth,
                      const std::vector<fs::path>* frames) {
  const PosePairs pairs = pair_by_stamp(read_tum(file), truth);
  if (pairs.size() == 0)
    io::refuse(file,
               "none of its stamps lies within 2 ms of a stamp of the truth: give a trajectory of "
               "this sequence");
  TrajectoryScore result{pairs.size(), absolute_error(pairs), relative_error(pairs), {}};
  if (frames && pairs.size() == truth.size())
    result.ghosting = ghosting(*frames, pairs.estimate, truth.T_world_frame);
  return result;
}

}  // namespace

Evaluation evaluate(const EvaluationInput& input) {
  io::require_folder(input.sequence, "give the folder of a sequence");
  const auto truth_file = input.truth.empty() ? input.sequence / "truth.tum" : input.truth;
  if (input.truth.empty() && !fs::exists(truth_file))
    io::refuse(input.sequence, "has no truth.tum to judge by: give one with --truth");
  const Trajectory truth = read_tum(truth_file);
  std::vector<fs::path> frames;
  if (input.clouds) {
    frames = frames_of(input.sequence);
    if (frames.size() < truth.size())
      io::refuse(input.sequence,
                 "has " + std::to_string(frames.size()) + " frames for " +
                     std::to_string(truth.size()) +
                     " true poses: give the frames all poses belong to, or leave --clouds out");
  }
  const auto* used = input.clouds ? &frames : nullptr;
  Evaluation result{truth.size(), {}, score(input.trajectory, truth, used)};
  if (const auto odometry = input.sequence / "odometry.tum"; fs::exists(odometry))
    result.before = score(odometry, truth, used);
  return result;
}

}  // namespace plumb
