#include "gate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "shared/selection/median.hpp"

namespace plumb::gate_distance {

double change_of(double r0, double r1) {
  const double sum = r0 + r1;
  if (sum <= 0) return 0;
  const double ratio = (r0 - r1) / sum;
  return ratio * ratio;
}

namespace {

/// Stretches [s] between each scan and the one before it in the sequence; 0 where stamps step back.
std::vector<double> stretches(const std::vector<Seen>& scans) {
  std::vector<double> between(scans.size(), 0);
  for (std::size_t k = 1; k < scans.size(); ++k)
    between[k] = std::max(0.0, scans[k].begin - scans[k - 1].end);
  return between;
}

double median_of_positive(std::vector<double> values) {
  std::erase_if(values, [](double v) { return v <= 0; });
  return selection::median(std::move(values));
}

}  // namespace

Gated gated_chain(const std::vector<Seen>& scans, const GateOptions& options) {
  Gated result;
  result.edges.segments = static_cast<std::uint32_t>(scans.size());
  const std::vector<double> between = stretches(scans);
  const double longest =
      options.max_time_gap
          ? std::max(*options.max_time_gap, options.patience * median_of_positive(between))
          : 0;
  std::optional<std::uint32_t> last;
  std::uint32_t dropped = 0;  // for their change, since the last accepted one
  bool after_gap = false;     // since the last accepted one
  for (std::uint32_t k = 0; k < scans.size(); ++k) {
    after_gap = after_gap || (options.max_time_gap && between[k] > longest);
    if (scans[k].points < options.min_points) {
      ++result.empty;
      continue;
    }
    EdgeKind kind = EdgeKind::sequential;
    if (last && after_gap) {
      ++result.resets, ++result.gaps;
      kind = EdgeKind::neighbour;
    } else if (last && change_of(scans[k].range, scans[*last].range) > options.limit) {
      if (dropped < options.patience) {
        ++dropped;
        ++result.far;
        continue;
      }
      ++result.resets;
      kind = EdgeKind::neighbour;
    }
    if (last) {
      const auto step = static_cast<float>(std::abs(scans[k].range - scans[*last].range));
      result.edges.list.push_back({*last, k, kind, 1, step});
    }
    ++result.accepted;
    last = k;
    dropped = 0, after_gap = false;
  }
  return result;
}

}  // namespace plumb::gate_distance
