#include "gate.hpp"

#include <cmath>
#include <optional>

namespace plumb {

double change_of(double r0, double r1) {
  const double sum = r0 + r1;
  if (sum <= 0) return 0;
  const double ratio = (r0 - r1) / sum;
  return ratio * ratio;
}

Gated gated_chain(const std::vector<Seen>& scans, const GateOptions& options) {
  Gated result;
  result.edges.segments = static_cast<std::uint32_t>(scans.size());
  std::optional<std::uint32_t> last;
  std::uint32_t dropped = 0;  // for their change, since the last accepted one
  for (std::uint32_t k = 0; k < scans.size(); ++k) {
    if (scans[k].points < options.least_points) {
      ++result.empty;
      continue;
    }
    EdgeKind kind = EdgeKind::sequential;
    if (last && change_of(scans[k].range, scans[*last].range) > options.limit) {
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
    dropped = 0;
  }
  return result;
}

}  // namespace plumb
