#include "plumb/slam/report/evaluation.hpp"

#include <cmath>
#include <numbers>

#include "plumb/data/counted.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/slam/io/frame_files.hpp"
#include "plumb/slam/io/trajectory_file.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;

TrajectoryScore score(const fs::path& file, const Trajectory& truth,
                      const std::vector<fs::path>* frames) {
  const PosePairs pairs = pair_by_stamp(read_tum(file, StampOrder::any), truth);
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
  const Trajectory truth = read_tum(truth_file, StampOrder::any);
  std::vector<fs::path> frames;
  if (input.clouds) {
    for (auto& file : io::sequence_frames(input.sequence)) frames.push_back(std::move(file.path));
    if (frames.size() < truth.size())
      io::refuse(input.sequence,
                 "has " + counted(frames.size(), "frames") + " for " +
                     counted(truth.size(), "true poses") +
                     ": give the frames all poses belong to, or leave --clouds out");
  }
  const auto* used = input.clouds ? &frames : nullptr;
  Evaluation result{truth.size(), {}, score(input.trajectory, truth, used)};
  if (const auto odometry = input.sequence / "odometry.tum"; fs::exists(odometry))
    result.before = score(odometry, truth, used);
  return result;
}

}  // namespace plumb
