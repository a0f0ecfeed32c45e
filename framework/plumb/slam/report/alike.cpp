#include "plumb/slam/report/alike.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

#include "plumb/data/error.hpp"
#include "plumb/slam/io/frame_files.hpp"
#include "plumb/slam/io/frame_selection.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "plumb/slam/report/ghosting.hpp"
#include "plumb/slam/trajectory_error.hpp"

namespace plumb {
namespace {

using experiment::Figure, experiment::SegmentSums;

constexpr std::size_t parts_of_path = 20;
constexpr std::size_t most_alike = 60;

/// A stamp as files have it.
std::int64_t key_of(double stamp) { return std::llround(1e6 * stamp); }

/// Stamps that all trajectories have, rising.
std::vector<std::int64_t> common_stamps(const std::vector<const Trajectory*>& trajectories) {
  std::vector<std::int64_t> common;
  for (std::size_t k = 0; k < trajectories.size(); ++k) {
    std::set<std::int64_t> keys;
    for (const double stamp : trajectories[k]->stamps) keys.insert(key_of(stamp));
    if (k == 0)
      common.assign(keys.begin(), keys.end());
    else
      std::erase_if(common, [&](std::int64_t key) { return !keys.contains(key); });
  }
  return common;
}

Trajectory at_stamps(const Trajectory& trajectory, const std::vector<std::int64_t>& stamps) {
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < trajectory.size(); ++k)
    if (std::ranges::binary_search(stamps, key_of(trajectory.stamps[k]))) kept.push_back(k);
  return kept.size() == trajectory.size() ? trajectory : io::selected(trajectory, kept);
}

Figure* find(experiment::Cell& cell, const std::string& name) {
  for (Figure& figure : cell.figures)
    if (figure.number.name == name) return &figure;
  return nullptr;
}

/// Which part of the true path each pose lies in.
std::vector<std::size_t> parts_of(const std::vector<Pose>& truth) {
  const auto path = path_of(truth);
  std::vector<std::size_t> parts;
  for (const double s : path) {
    const double share = path.back() > 0 ? s / path.back() : 0;
    parts.push_back(std::min(static_cast<std::size_t>(share * parts_of_path), parts_of_path - 1));
  }
  return parts;
}

/// Sets the sums of a number where they give it; with `anew` also its value, or there is none.
void set_sums(experiment::Cell& cell, const std::string& name, bool root,
              const std::vector<std::size_t>& parts, const std::vector<double>& values, bool anew) {
  Figure* figure = find(cell, name);
  if (!figure) return;
  SegmentSums sums{root, std::vector<double>(parts_of_path), std::vector<double>(parts_of_path)};
  for (std::size_t k = 0; k < values.size(); ++k) {
    sums.sum[parts[k]] += values[k];
    ++sums.count[parts[k]];
  }
  const double value = sums.value();
  if (anew && !std::isfinite(value)) {
    std::erase_if(cell.figures, [&](const Figure& one) { return one.number.name == name; });
    return;
  }
  if (anew) figure->number.value = value;
  constexpr double rounding = 1e-5;  // of files, and of the order in which is summed
  if (std::abs(value - figure->number.value) <= rounding * (std::abs(value) + rounding))
    figure->segments = std::move(sums);
}

/// Takes away the numbers of a trajectory that stand for other stamps than the common ones and are
/// not taken anew.
void erase_others(experiment::Cell& cell, const std::string& prefix, bool all) {
  std::erase_if(cell.figures, [&](const Figure& figure) {
    const std::string& name = figure.number.name;
    const bool is_taken_anew = name == prefix + "ate" || name == prefix + "rpe_translation" ||
                               name == prefix + "rpe_rotation";
    return name.starts_with(prefix) && (all || !is_taken_anew);
  });
}

/// `anew`: some of the runs have other stamps.
void judge_run(experiment::Cell& cell, const WrittenTrajectory& written, const Trajectory& truth,
               const std::vector<std::int64_t>& stamps, bool anew) {
  const PosePairs pairs =
      pair_by_stamp(at_stamps(written.trajectory, stamps), truth, written.tolerance);
  const bool too_few = pairs.size() < 3;
  if (anew) erase_others(cell, written.prefix, too_few);
  if (too_few) return;
  const auto parts = parts_of(pairs.truth);
  set_sums(cell, written.prefix + "ate", true, parts, squared_errors(pairs), anew);
  std::vector<double> translations, rotations;
  for (const RelativeError& error : relative_errors(pairs, written.delta)) {
    translations.push_back(error.translation);
    rotations.push_back(error.rotation);
  }
  set_sums(cell, written.prefix + "rpe_translation", false, parts, translations, anew);
  set_sums(cell, written.prefix + "rpe_rotation", false, parts, rotations, anew);
}

/// The pairs that some of the trajectories have near, as many of each as there is room for.
std::vector<Revisit> pooled_revisits(const std::vector<std::vector<Pose>>& poses) {
  std::vector<std::vector<Revisit>> of_each;
  for (const auto& each : poses) of_each.push_back(revisits_of(each));
  std::vector<Revisit> pooled;
  std::set<std::pair<std::size_t, std::size_t>> seen;
  for (std::size_t rank = 0; rank < most_alike; ++rank)
    for (const auto& revisits : of_each) {
      // Spread over all of them: their first ones may lie in one street.
      const std::size_t stride =
          std::max<std::size_t>(1, revisits.size() * poses.size() / most_alike);
      if (rank * stride >= revisits.size() || pooled.size() >= most_alike) continue;
      const Revisit& revisit = revisits[rank * stride];
      if (seen.insert({revisit.first, revisit.second}).second) pooled.push_back(revisit);
    }
  return pooled;
}

/// Poses of each frame's file, by trajectory, and the files: of the stamps that all have.
struct Placed {
  std::vector<std::filesystem::path> files;
  std::vector<std::vector<Pose>> poses;
};

Placed placed_frames(const std::vector<const WrittenTrajectory*>& written) {
  auto files = io::sequence_frames(written.front()->frames);
  const Trajectory odometry = read_tum(written.front()->odometry);
  Placed placed;
  if (files.size() != odometry.size()) return placed;
  std::unordered_map<std::int64_t, std::size_t> frame_at;
  for (std::size_t k = 0; k < odometry.size(); ++k) frame_at.emplace(key_of(odometry.stamps[k]), k);
  std::vector<const Trajectory*> trajectories{&odometry};
  for (const WrittenTrajectory* one : written) trajectories.push_back(&one->trajectory);
  const auto stamps = common_stamps(trajectories);
  for (const std::int64_t stamp : stamps) placed.files.push_back(files[frame_at.at(stamp)].path);
  for (const WrittenTrajectory* one : written) {
    placed.poses.push_back(at_stamps(one->trajectory, stamps).T_world_frame);
    if (placed.poses.back().size() != stamps.size()) return {};  // a stamp twice
  }
  return placed;
}

}  // namespace

std::size_t judge_at_same_stamps(std::vector<RunBeside>& runs) {
  std::vector<const Trajectory*> trajectories;
  for (const RunBeside& run : runs)
    if (run.written && !run.written->truth.empty())
      trajectories.push_back(&run.written->trajectory);
  const auto stamps = common_stamps(trajectories);
  std::size_t left_out = 0;
  for (const Trajectory* one : trajectories)
    left_out = std::max(left_out, one->size() - at_stamps(*one, stamps).size());
  for (RunBeside& run : runs)
    if (run.written && !run.written->truth.empty())
      judge_run(*run.cell, *run.written, read_tum(run.written->truth, StampOrder::any), stamps,
                left_out > 0);
  return left_out;
}

void add_sharpness(std::vector<RunBeside>& runs) {
  std::vector<const WrittenTrajectory*> written;
  std::vector<RunBeside*> sharp;
  for (RunBeside& run : runs)
    if (run.written && !run.written->frames.empty() &&
        (written.empty() || run.written->frames == written.front()->frames)) {
      written.push_back(&*run.written);
      sharp.push_back(&run);
    }
  if (written.empty()) return;
  Placed placed;
  std::vector<std::vector<double>> gaps;
  try {
    placed = placed_frames(written);
    const auto revisits = pooled_revisits(placed.poses);
    if (revisits.empty()) return;
    std::vector<const std::vector<Pose>*> poses;
    for (const auto& each : placed.poses) poses.push_back(&each);
    gaps = revisit_gaps(placed.files, revisits, poses);
  } catch (const Error&) {
    return;  // frames that are not in files of their own, or one without points
  }
  for (std::size_t k = 0; k < sharp.size(); ++k) {
    std::erase_if(gaps[k], [](double gap) { return std::isnan(gap); });
    const double sharpness = quantile(gaps[k], 0.5);
    if (std::isfinite(sharpness))
      sharp[k]->cell->figures.push_back({{"sharpness", sharpness, "m"}});
  }
}

}  // namespace plumb
