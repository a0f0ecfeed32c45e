#include "loops.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "shared/selection/evenly.hpp"
#include "shared/selection/median.hpp"

namespace plumb::loops_scan_context {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

constexpr std::size_t most_pairs_for_threshold = 20000;

class LoopSearch {
 public:
  LoopSearch(const std::vector<Place>& places, const LoopOptions& options, Context& context)
      : places_(places),
        options_(options),
        context_(context),
        count_(static_cast<std::uint32_t>(places.size())),
        path_(count_, 0) {
    std::vector<double> steps;
    for (std::uint32_t k = 0; k + 1 < count_; ++k) {
      steps.push_back((places[k + 1].position - places[k].position).norm());
      path_[k + 1] = path_[k] + steps.back();
    }
    step_ = selection::median(steps);
    found_.min_path_separation = options.min_path_separation.value_or(4 * step_);
    found_.edges.segments = count_;
  }

  Loops run() && {
    found_.threshold = options_.threshold ? *options_.threshold : threshold_of_all();
    std::vector<std::vector<std::pair<double, std::uint32_t>>> partners(count_);
    context_.parallel(
        count_, [&](std::size_t k) { partners[k] = partners_of(static_cast<std::uint32_t>(k)); });
    std::map<Pair, double> edges;
    for (std::uint32_t k = 0; k < count_; ++k)
      for (const auto& [alike, other] : partners[k]) edges[std::minmax(k, other)] = alike;
    for (const auto& [ends, alike] : edges)
      found_.edges.list.push_back(
          {ends.first, ends.second, EdgeKind::loop, static_cast<float>(alike),
           static_cast<float>(
               (places_[ends.first].centroid - places_[ends.second].centroid).norm())});
    return std::move(found_);
  }

 private:
  /// Whether they may be two visits, wherever they are.
  bool apart(std::uint32_t i, std::uint32_t j) const {
    const auto [first, second] = std::minmax(i, j);
    return second - first >= 2 && path_[second] - path_[first] >= found_.min_path_separation;
  }
  bool near_enough(std::uint32_t i, std::uint32_t j) const {
    if (!options_.drift) return true;
    const double distance = (places_[i].centroid - places_[j].centroid).norm();
    return distance <= 2 * step_ + *options_.drift * std::abs(path_[i] - path_[j]);
  }

  double threshold_of_all() const {
    std::vector<double> similarities = similarities_of_pairs();
    const double middle = selection::median(similarities);
    for (double& value : similarities) value = std::abs(value - middle);
    constexpr double of_normal = 1.4826;  // standard deviation / median absolute deviation
    return middle + options_.stddev_mul_thresh * of_normal * selection::median(similarities);
  }

  std::vector<double> similarities_of_pairs() const {
    std::size_t all = 0;
    for (std::uint32_t i = 0; i < count_; ++i)
      for (std::uint32_t j = i + 1; j < count_; ++j) all += apart(i, j);
    const auto wanted = selection::evenly(all, most_pairs_for_threshold);
    std::vector<Pair> pairs;
    std::size_t at = 0;
    for (std::uint32_t i = 0; i < count_; ++i)
      for (std::uint32_t j = i + 1; j < count_ && pairs.size() < wanted.size(); ++j)
        if (apart(i, j) && at++ == wanted[pairs.size()]) pairs.emplace_back(i, j);
    std::vector<double> similarities(pairs.size());
    context_.parallel(pairs.size(), [&](std::size_t n) {
      similarities[n] =
          similarity(places_[pairs[n].first].context, places_[pairs[n].second].context);
    });
    return similarities;
  }

  /// The most similar first; of equals the lower index.
  std::vector<std::pair<double, std::uint32_t>> partners_of(std::uint32_t k) const {
    std::vector<std::pair<float, std::uint32_t>> by_key;
    for (std::uint32_t other = 0; other < count_; ++other)
      if (apart(k, other) && near_enough(k, other))
        by_key.emplace_back(
            (places_[k].context.ring_key - places_[other].context.ring_key).squaredNorm(), other);
    const auto few = std::min<std::size_t>(options_.candidates, by_key.size());
    std::ranges::partial_sort(by_key, by_key.begin() + static_cast<std::ptrdiff_t>(few));
    std::vector<std::pair<double, std::uint32_t>> partners;
    for (std::size_t n = 0; n < few; ++n) {
      // Both ends of a pair ask in the same order, so that they are told the same number.
      const auto [first, second] = std::minmax(k, by_key[n].second);
      const double alike = similarity(places_[first].context, places_[second].context);
      if (alike >= found_.threshold) partners.emplace_back(alike, by_key[n].second);
    }
    std::ranges::sort(partners, [](const auto& a, const auto& b) {
      return std::pair(-a.first, a.second) < std::pair(-b.first, b.second);
    });
    partners.resize(std::min<std::size_t>(partners.size(), options_.loops_per_segment));
    return partners;
  }

  const std::vector<Place>& places_;
  const LoopOptions& options_;
  Context& context_;
  std::uint32_t count_;
  std::vector<double> path_;
  double step_ = 0;
  Loops found_;
};

}  // namespace

Loops find_loops(const std::vector<Place>& places, const LoopOptions& options, Context& context) {
  return LoopSearch(places, options, context).run();
}

}  // namespace plumb::loops_scan_context
