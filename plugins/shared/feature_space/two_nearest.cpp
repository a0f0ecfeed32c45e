#include "shared/feature_space/two_nearest.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace plumb::feature_space {
namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t block_rows = 32;
constexpr float float_infinity = std::numeric_limits<float>::infinity();

double squared_distance(const float* a, const float* b, std::size_t dimension) {
  double sum = 0;
  for (std::size_t d = 0; d < dimension; ++d) {
    const double difference = static_cast<double>(a[d]) - static_cast<double>(b[d]);
    sum += difference * difference;
  }
  return sum;
}

/// The vectors that are numbers, one a row, and where each was.
struct Packed {
  Rows rows;
  std::vector<std::uint32_t> place;
  std::vector<float> squared_lengths;
  float longest = 0;  ///< the greatest squared length

  Packed(std::span<const float> vectors, std::size_t dimension) {
    const std::vector<float> zero(dimension, 0);
    for (std::uint32_t k = 0; k < vectors.size() / dimension; ++k) {
      const double length = squared_distance(&vectors[k * dimension], zero.data(), dimension);
      if (!(length < std::numeric_limits<float>::max())) continue;
      place.push_back(k);
      squared_lengths.push_back(static_cast<float>(length));
      longest = std::max(longest, squared_lengths.back());
    }
    rows.resize(static_cast<Eigen::Index>(place.size()), static_cast<Eigen::Index>(dimension));
    for (std::size_t r = 0; r < place.size(); ++r)
      std::copy_n(&vectors[place[r] * dimension], dimension, row(r));
  }
  std::size_t count() const { return place.size(); }
  float* row(std::size_t r) { return rows.data() + r * static_cast<std::size_t>(rows.cols()); }
  const float* row(std::size_t r) const {
    return rows.data() + r * static_cast<std::size_t>(rows.cols());
  }
};

/// Distances by products of matrices in float, less the squared length of who asks, tell who may be
/// nearest; distances in double tell who is.
class Search {
 public:
  Search(const Packed& of, const Packed& among, const Apart& apart)
      : of_(of), among_(among), apart_(apart), about_(among.count()) {}

  void run(std::vector<TwoNearest>& found) {
    Rows products;
    for (std::size_t first = 0; first < of_.count(); first += block_rows) {
      const std::size_t size = std::min(block_rows, of_.count() - first);
      products.noalias() =
          of_.rows.middleRows(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(size)) *
          among_.rows.transpose();
      for (std::size_t r = 0; r < size; ++r) {
        const float* product = products.data() + r * among_.count();
        for (std::size_t k = 0; k < among_.count(); ++k)
          about_[k] = among_.squared_lengths[k] - 2 * product[k];
        find(first + r, found[of_.place[first + r]]);
      }
    }
  }

 private:
  /// Twice the most by which a distance in `about_` may be off: that of a sum of products of
  /// `dimension` terms, in any order, and of the two sums that follow.
  float slack(std::size_t asking) const {
    const auto terms = static_cast<float>(of_.rows.cols() + 8);
    return 2 * terms * 0x1.0p-23f * (of_.squared_lengths[asking] + among_.longest);
  }

  void find(std::size_t asking, TwoNearest& to) const {
    const float allowed = slack(asking);
    const float least = *std::min_element(about_.begin(), about_.end());
    std::size_t first = 0;
    for (std::size_t k = 0; k < about_.size(); ++k)
      if (about_[k] <= least + allowed && offer(asking, k, to.first, to.first_squared)) first = k;
    if (to.first == none) return;

    const auto may_be_second = [&](std::size_t k) {
      return k != first && (!apart_ || apart_(to.first, among_.place[k]));
    };
    float next = float_infinity;
    for (std::size_t k = 0; k < about_.size(); ++k)
      if (about_[k] < next && may_be_second(k)) next = about_[k];
    for (std::size_t k = 0; k < about_.size(); ++k)
      if (about_[k] <= next + allowed && may_be_second(k))
        offer(asking, k, to.second, to.second_squared);
  }

  /// Places rise with k, so an equally near one that comes later does not replace an earlier one.
  bool offer(std::size_t asking, std::size_t k, std::uint32_t& place, double& squared) const {
    const double exact =
        squared_distance(of_.row(asking), among_.row(k), static_cast<std::size_t>(of_.rows.cols()));
    if (!(exact < squared)) return false;
    squared = exact;
    place = among_.place[k];
    return true;
  }

  const Packed &of_, &among_;
  const Apart& apart_;
  std::vector<float> about_;  ///< of the vector at hand to each of the others, nearly
};

}  // namespace

std::vector<TwoNearest> two_nearest(std::span<const float> of, std::span<const float> among,
                                    std::size_t dimension, const Apart& apart) {
  if (dimension == 0) return {};
  std::vector<TwoNearest> found(of.size() / dimension);
  const Packed asking(of, dimension), asked(among, dimension);
  if (asking.count() > 0 && asked.count() > 0) Search(asking, asked, apart).run(found);
  return found;
}

}  // namespace plumb::feature_space
