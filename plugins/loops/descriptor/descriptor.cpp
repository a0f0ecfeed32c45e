#include "descriptor.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "shared/selection/median.hpp"

namespace plumb::loops_descriptor {
namespace {

struct Seed {
  double similarity;
  std::uint32_t i, j;
};

/// The search, with what stays the same throughout.
class LoopSearch {
 public:
  using Alike = std::function<double(std::uint32_t, std::uint32_t)>;

  LoopSearch(const Places& places, const Alike& alike, const LoopOptions& options)
      : places_(places),
        alike_(alike),
        options_(options),
        count_(static_cast<std::uint32_t>(places.positions.size())) {
    std::vector<double> steps, similarities;
    path_.assign(count_, 0);
    for (std::uint32_t k = 0; k + 1 < count_; ++k) {
      steps.push_back((places.positions[k + 1] - places.positions[k]).norm());
      path_[k + 1] = path_[k] + steps.back();
      if (!options.threshold) similarities.push_back(alike(k, k + 1));
    }
    found_.min_path_separation = options.min_path_separation.value_or(4 * selection::median(steps));
    found_.max_centroid_distance =
        options.max_centroid_distance.value_or(2 * selection::median(steps));
    found_.threshold =
        options.threshold.value_or(options.relative_threshold * selection::median(similarities));
    found_.edges.segments = count_;
    loops_of_.assign(count_, 0);
  }

  Loops run() && {
    for (const Seed& seed : seeds()) {
      if (options_.max_walks && found_.walks >= *options_.max_walks) break;
      if (!wanted(seed.i, seed.j)) continue;
      ++found_.walks;
      add(seed.i, seed.j, seed.similarity);
      const auto same = walk(seed, +1);
      const auto back = options_.either_direction ? walk(seed, -1) : std::vector<Seed>();
      const auto sum = [](const std::vector<Seed>& way) {
        double s = 0;
        for (const Seed& pair : way) s += pair.similarity;
        return s;
      };
      for (const Seed& pair : sum(same) >= sum(back) ? same : back)
        if (wanted(pair.i, pair.j)) add(pair.i, pair.j, pair.similarity);
    }
    std::ranges::sort(found_.edges.list, {}, [](const Edge& e) { return std::pair(e.i, e.j); });
    return std::move(found_);
  }

 private:
  double distance(std::uint32_t i, std::uint32_t j) const {
    return (places_.centroids[i] - places_.centroids[j]).norm();
  }
  bool allowed(std::uint32_t i, std::uint32_t j) const {
    const auto [first, second] = std::minmax(i, j);
    if (second - first < 2) return false;
    const double gap = path_[second] - path_[first];
    return gap >= found_.min_path_separation &&
           distance(i, j) <= found_.max_centroid_distance + options_.drift * gap;
  }
  /// Whether an edge would be new to an end that has too few.
  bool wanted(std::uint32_t i, std::uint32_t j) const {
    return std::min(loops_of_[i], loops_of_[j]) < options_.loops_per_segment &&
           !taken_.contains({i, j});
  }
  void add(std::uint32_t i, std::uint32_t j, double similarity) {
    taken_.insert({i, j});
    ++loops_of_[i];
    ++loops_of_[j];
    found_.edges.list.push_back(
        {i, j, EdgeKind::loop, static_cast<float>(similarity), static_cast<float>(distance(i, j))});
  }

  /// Every segment with each of its partners, once, the most similar pair first.
  std::vector<Seed> seeds() const {
    std::vector<Seed> all;
    std::vector<std::pair<double, std::uint32_t>> near;
    for (std::uint32_t i = 0; i < count_; ++i) {
      near.clear();
      for (std::uint32_t j = 0; j < count_; ++j)
        if (allowed(i, j)) near.emplace_back(distance(i, j), j);
      const auto few = std::min<std::size_t>(options_.candidates, near.size());
      std::ranges::partial_sort(near, near.begin() + static_cast<std::ptrdiff_t>(few));
      std::vector<Seed> partners;
      for (std::size_t k = 0; k < few; ++k) {
        const auto [first, second] = std::minmax(i, near[k].second);
        partners.push_back({alike_(first, second), first, second});
      }
      std::ranges::stable_sort(partners, std::ranges::greater(), &Seed::similarity);
      partners.resize(std::min<std::size_t>(partners.size(), options_.loops_per_segment));
      std::erase_if(partners, [&](const Seed& s) { return s.similarity < found_.threshold; });
      all.insert(all.end(), partners.begin(), partners.end());
    }
    std::ranges::sort(all, [](const Seed& a, const Seed& b) {
      return std::tuple(-a.similarity, a.i, a.j) < std::tuple(-b.similarity, b.i, b.j);
    });
    return all;
  }

  /// The pairs on both sides of the seed; `way` is +1 if both passes go the same way, else -1.
  std::vector<Seed> walk(const Seed& seed, int way) const {
    std::vector<Seed> pairs;
    const std::int64_t stride = options_.stride;
    for (const std::int64_t step : {+stride, -stride})
      for (std::int64_t i = seed.i + step, j = seed.j + step * way;
           i >= 0 && j >= 0 && i < j && j < count_; i += step, j += step * way) {
        const auto a = static_cast<std::uint32_t>(i), b = static_cast<std::uint32_t>(j);
        if (!allowed(a, b)) break;
        const double similarity = alike_(a, b);
        if (similarity < found_.threshold) break;
        pairs.push_back({similarity, a, b});
      }
    return pairs;
  }

  const Places& places_;
  const Alike& alike_;
  const LoopOptions& options_;
  std::uint32_t count_;
  std::vector<double> path_;
  std::vector<std::uint32_t> loops_of_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> taken_;
  Loops found_;
};

}  // namespace

Loops find_loops(const Places& places,
                 const std::function<double(std::uint32_t, std::uint32_t)>& alike,
                 const LoopOptions& options) {
  return LoopSearch(places, alike, options).run();
}

}  // namespace plumb::loops_descriptor
