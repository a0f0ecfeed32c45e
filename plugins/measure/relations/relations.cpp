#include "relations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "plumb/data/io/file_text.hpp"

namespace plumb::measure_relations {
namespace {

Spread spread_of(const std::vector<double>& values) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  if (values.empty()) return {nan, nan};
  const auto n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double v : values) sum += v;
  const double mean = sum / n;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, std::sqrt(squares / n)};
}

std::vector<double> squared(std::vector<double> values) {
  for (double& v : values) v *= v;
  return values;
}

Eigen::Quaterniond about(double angle, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

}  // namespace

RelationsFile read_relations(const std::filesystem::path& file) {
  const io::FileBytes bytes(file);
  io::Lines lines(bytes.view());
  RelationsFile result;
  for (std::string_view line; lines.next(line);) {
    std::array<double, 8> v;
    std::size_t have = 0;
    for (; have < v.size(); ++have) {
      const auto word = io::next_word(line);
      if (word.empty() || (have == 0 && word.front() == '#')) break;
      if (!io::to_number(word, v[have]) || !std::isfinite(v[have]))
        io::refuse(file, lines.number(),
                   "expected 'from to x y z roll pitch yaw', found " + io::in_quotes(word));
    }
    if (have < v.size()) {
      result.too_short += have > 0;
      continue;
    }
    const Eigen::Quaterniond rotation = about(v[7], Eigen::Vector3d::UnitZ()) *
                                        about(v[6], Eigen::Vector3d::UnitY()) *
                                        about(v[5], Eigen::Vector3d::UnitX());
    result.relations.push_back(
        {v[0], v[1], {rotation.normalized(), Eigen::Vector3d(v[2], v[3], v[4])}});
  }
  if (result.relations.empty())
    io::refuse(file, "holds no relation: give lines 'from to x y z roll pitch yaw'");
  return result;
}

NearestStamp::NearestStamp(const std::vector<double>& stamps) {
  for (std::size_t k = 0; k < stamps.size(); ++k) sorted_.emplace_back(stamps[k], k);
  std::ranges::sort(sorted_);
}

std::size_t NearestStamp::of(double stamp) const {
  const auto first_of = [&](double value) {
    return std::ranges::lower_bound(sorted_, std::pair(value, std::size_t{0}));
  };
  const auto after = first_of(stamp);
  if (after == sorted_.begin()) return after->second;
  const auto before = first_of((after - 1)->first);
  if (after == sorted_.end()) return before->second;
  const double down = std::abs(before->first - stamp), up = std::abs(after->first - stamp);
  if (down == up) return std::min(before->second, after->second);
  return down < up ? before->second : after->second;
}

RelationErrors relation_errors(const std::vector<TrueRelation>& relations,
                               const Trajectory& trajectory, double tolerance) {
  const NearestStamp nearest(trajectory.stamps);
  std::vector<double> translation, rotation;
  if (trajectory.size() > 0) {
    for (const TrueRelation& relation : relations) {
      const std::size_t i = nearest.of(relation.from), j = nearest.of(relation.to);
      if (std::abs(trajectory.stamps[i] - relation.from) > tolerance ||
          std::abs(trajectory.stamps[j] - relation.to) > tolerance)
        continue;
      const Pose T_i_j = trajectory.T_world_frame[i].inverse() * trajectory.T_world_frame[j];
      const Pose error = relation.T_from_to.inverse() * T_i_j;
      translation.push_back(error.translation.norm());
      rotation.push_back(angle(error));
    }
  }
  return {translation.size(), spread_of(translation), spread_of(rotation),
          spread_of(squared(translation)), spread_of(squared(rotation))};
}

}  // namespace plumb::measure_relations
