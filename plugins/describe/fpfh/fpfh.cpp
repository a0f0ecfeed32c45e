#include "fpfh.hpp"

#include <algorithm>
#include <limits>

#include "border.hpp"
#include "pair_counts.hpp"

namespace plumb::describe_fpfh {
namespace {

constexpr std::size_t block_points = 1024;  // fixed, so that blocks do not follow the threads
constexpr std::size_t dimension = 3 * fpfh_bins;
constexpr std::uint32_t no_key = std::numeric_limits<std::uint32_t>::max();

/// One point's counts in 80 bytes: bin k is value[k] * scale.
struct Histogram {
  std::uint16_t value[40] = {};
};

Oriented point_at(const Support& s, std::uint32_t place) {
  return {s.x[place], s.y[place], s.z[place], s.nx[place], s.ny[place], s.nz[place]};
}

/// The squared radius within which `point` has at most `most` neighbours, all of them if they are
/// as near as the last.
float squared_reach(const Oriented& point, const Candidates& candidates, const FpfhOptions& options,
                    std::vector<float>& scratch) {
  const auto r = static_cast<float>(options.radius);
  if (!options.max_neighbours) return r * r;
  scratch.clear();
  for (std::size_t k = 0; k < candidates.size; ++k) {
    const float dx = candidates.x[k] - point.x, dy = candidates.y[k] - point.y,
                dz = candidates.z[k] - point.z;
    const float squared = (dx * dx + dy * dy) + dz * dz;
    if (squared <= r * r) scratch.push_back(squared);
  }
  if (scratch.size() <= *options.max_neighbours) return r * r;
  const auto last = scratch.begin() + (*options.max_neighbours - 1);
  std::nth_element(scratch.begin(), last, scratch.end());
  return *last;
}

/// Calls visit(place, candidates) for every point of the support, in parallel over fixed blocks of
/// cells. `wanted(cell)` tells which cells matter.
template <class Wanted, class Visit>
void for_each_point(const Support& support, Context& context, const Wanted& wanted,
                    const Visit& visit) {
  const auto blocks = support.blocks(block_points);
  if (blocks.size() < 2) return;
  context.parallel(blocks.size() - 1, [&](std::size_t block) {
    CandidateFinder finder(support);
    std::vector<float> scratch;
    for (std::size_t c = blocks[block]; c < blocks[block + 1]; ++c) {
      const auto& cell = support.cells()[c];
      if (!wanted(cell)) continue;
      const Candidates& candidates = finder.around(cell);
      for (auto place = cell.first; place < cell.end; ++place) visit(place, candidates, scratch);
    }
  });
}

/// S of every point: counts and what to multiply them by.
struct Spfh {
  std::vector<Histogram> counts;
  std::vector<float> scale;

  void set(std::uint32_t place, const PairCounts& pairs) {
    if (pairs.neighbours < 2) return;
    std::uint32_t most = 0;
    for (const auto n : pairs.bins) most = std::max(most, n);
    int shift = 0;
    while ((most >> shift) > std::numeric_limits<std::uint16_t>::max()) ++shift;
    for (std::size_t b = 0; b < dimension; ++b)
      counts[place].value[b] = static_cast<std::uint16_t>(pairs.bins[b] >> shift);
    scale[place] = static_cast<float>(1u << shift) / static_cast<float>(pairs.neighbours - 1);
  }
};

/// F of one point into `out`; returns how many neighbours it has, itself included.
std::size_t weigh(const Oriented& point, const Candidates& candidates, float squared_radius,
                  const Spfh& spfh, float* out) {
  float sums[40] = {};
  std::size_t neighbours = 0;
  for (std::size_t k = 0; k < candidates.size; k += Candidates::lanes) {
    float squared[Candidates::lanes];
    bool any = false;
    for (std::size_t j = 0; j < Candidates::lanes; ++j) {
      const float dx = candidates.x[k + j] - point.x, dy = candidates.y[k + j] - point.y,
                  dz = candidates.z[k + j] - point.z;
      squared[j] = (dx * dx + dy * dy) + dz * dz;
      any |= squared[j] <= squared_radius;
    }
    if (!any) continue;
    for (std::size_t j = 0; j < Candidates::lanes; ++j) {
      if (!(squared[j] <= squared_radius)) continue;
      ++neighbours;
      if (squared[j] == 0) continue;
      const auto place = candidates.place[k + j];
      const float weight = spfh.scale[place] / squared[j];
      const std::uint16_t* value = spfh.counts[place].value;
      for (std::size_t b = 0; b < 40; ++b) sums[b] += weight * static_cast<float>(value[b]);
    }
  }
  for (std::size_t part = 0; part < 3; ++part) {
    double sum = 0;
    for (std::size_t b = 0; b < fpfh_bins; ++b) sum += sums[part * fpfh_bins + b];
    const double factor = sum > 0 ? 100 / sum : 0;
    for (std::size_t b = 0; b < fpfh_bins; ++b)
      out[part * fpfh_bins + b] = static_cast<float>(sums[part * fpfh_bins + b] * factor);
  }
  return neighbours;
}

}  // namespace

Fpfh fpfh(const Cloud& cloud, const std::vector<std::uint32_t>& keys, const FpfhOptions& options,
          Context& context) {
  const Support support(cloud, options.radius);
  Spfh spfh;
  spfh.counts.resize(support.size());
  spfh.scale.assign(support.size(), 0);
  for_each_point(
      support, context, [](const Support::Cell&) { return true; },
      [&](std::uint32_t place, const Candidates& candidates, std::vector<float>& scratch) {
        const Oriented point = point_at(support, place);
        spfh.set(place, count_pairs(point, candidates,
                                    squared_reach(point, candidates, options, scratch)));
      });

  std::vector<std::uint32_t> key_of_point(cloud.size(), no_key), key_at(support.size(), no_key);
  for (std::uint32_t k = 0; k < keys.size(); ++k) key_of_point[keys[k]] = k;
  for (std::size_t place = 0; place < support.size(); ++place)
    key_at[place] = key_of_point[support.index[place]];
  std::vector<float> vectors(keys.size() * dimension);
  std::vector<std::uint8_t> described(keys.size(), 0), at_border(keys.size(), 0);
  for_each_point(
      support, context,
      [&](const Support::Cell& cell) {
        return std::any_of(key_at.begin() + cell.first, key_at.begin() + cell.end,
                           [](std::uint32_t key) { return key != no_key; });
      },
      [&](std::uint32_t place, const Candidates& candidates, std::vector<float>& scratch) {
        const auto key = key_at[place];
        if (key == no_key) return;
        const Oriented point = point_at(support, place);
        const float reach = squared_reach(point, candidates, options, scratch);
        const auto neighbours =
            weigh(point, candidates, reach, spfh, vectors.data() + key * dimension);
        described[key] = neighbours > options.min_neighbours;
        at_border[key] = largest_gap(point, candidates, reach) > options.border_angle;
      });

  Fpfh result;
  result.features.dimension = dimension;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (!described[k]) {
      ++result.left_out;
      continue;
    }
    result.index.push_back(keys[k]);
    result.features.points.push_back(cloud.point(keys[k]));
    result.features.normals.push_back(cloud.normal(keys[k]));
    result.features.at_border.push_back(at_border[k]);
    const auto first = vectors.begin() + static_cast<long>(k * dimension);
    result.features.vectors.insert(result.features.vectors.end(), first, first + dimension);
  }
  return result;
}

}  // namespace plumb::describe_fpfh
