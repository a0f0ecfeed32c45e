#include "shared/planar/correlative_search.hpp"

#include <algorithm>
#include <cmath>

namespace plumb::planar {
namespace {

/// All poses with one yaw and a square of 2^level x 2^level cells of translations.
struct Branch {
  int yaw, column,
      row;    ///< number of the yaw; first translation, in cells from the window's low corner
  int bound;  ///< sum of values that no pose of the branch exceeds
};

class Search {
 public:
  Search(const LikelihoodField& field, const std::vector<float>& x, const std::vector<float>& y,
         const SearchWindow& window, double yaw_step, const std::optional<Excluded>& excluded)
      : field_(field), window_(window), yaw_step_(yaw_step), excluded_(excluded), count_(x.size()) {
    const double cell = field.resolution();
    half_columns_ = static_cast<int>(std::ceil(window.x / cell));
    half_rows_ = static_cast<int>(std::ceil(window.y / cell));
    half_yaws_ = static_cast<int>(std::ceil(window.yaw / yaw_step));
    cells_.resize(static_cast<std::size_t>(2 * half_yaws_ + 1) * count_);
    for (int n = 0; n <= 2 * half_yaws_; ++n) {
      const double angle = window.centre.yaw + (n - half_yaws_) * yaw_step;
      const double c = std::cos(angle), s = std::sin(angle);
      Eigen::Array2i* to = &cells_[static_cast<std::size_t>(n) * count_];
      for (std::size_t k = 0; k < count_; ++k)
        to[k] = field.cell(window.centre.x + c * x[k] - s * y[k],
                           window.centre.y + s * x[k] + c * y[k]) -
                Eigen::Array2i(half_columns_, half_rows_);
    }
  }

  std::optional<Peak> best(double least) {
    best_sum_ = static_cast<int>(least * 255 * static_cast<double>(count_));
    int level = 0;
    const int side = 2 * std::max(half_columns_, half_rows_) + 1;
    while (level + 1 < field_.levels() && (1 << (level + 1)) <= side) ++level;
    std::vector<Branch> roots;
    for (int n = 0; n <= 2 * half_yaws_; ++n)
      for (int row = 0; row <= 2 * half_rows_; row += 1 << level)
        for (int column = 0; column <= 2 * half_columns_; column += 1 << level)
          add(roots, n, column, row, level);
    descend(roots, level);
    if (!found_) return std::nullopt;
    return Peak{pose(*found_), best_sum_ / (255.0 * static_cast<double>(count_))};
  }

 private:
  void add(std::vector<Branch>& to, int yaw, int column, int row, int level) const {
    if (column > 2 * half_columns_ || row > 2 * half_rows_) return;
    const Eigen::Array2i* cells = &cells_[static_cast<std::size_t>(yaw) * count_];
    int sum = 0;
    for (std::size_t k = 0; k < count_; ++k)
      sum += field_.value(level, cells[k].x() + column, cells[k].y() + row);
    if (sum > best_sum_) to.push_back({yaw, column, row, sum});
  }

  void descend(std::vector<Branch>& branches, int level) {
    std::stable_sort(branches.begin(), branches.end(),
                     [](const Branch& a, const Branch& b) { return a.bound > b.bound; });
    for (const Branch& b : branches) {
      if (b.bound <= best_sum_) return;
      if (level == 0) {
        const int sum = b.bound - lost(b);
        if (sum <= best_sum_ || excluded(b)) continue;
        best_sum_ = sum, found_ = b;
        continue;
      }
      std::vector<Branch> parts;
      const int half = 1 << (level - 1);
      for (const int row : {b.row, b.row + half})
        for (const int column : {b.column, b.column + half})
          add(parts, b.yaw, column, row, level - 1);
      descend(parts, level - 1);
    }
  }

  /// What the window's prior takes from the sum of a single pose.
  int lost(const Branch& b) const {
    if (window_.prior.weight == 0) return 0;
    return static_cast<int>(window_.prior.lost(pose(b)) * 255 * static_cast<double>(count_));
  }

  PlanarPose pose(const Branch& b) const {
    return {window_.centre.x + (b.column - half_columns_) * field_.resolution(),
            window_.centre.y + (b.row - half_rows_) * field_.resolution(),
            wrapped(window_.centre.yaw + (b.yaw - half_yaws_) * yaw_step_)};
  }
  bool excluded(const Branch& b) const {
    if (!excluded_) return false;
    const PlanarPose p = pose(b);
    return std::hypot(p.x - excluded_->pose.x, p.y - excluded_->pose.y) < excluded_->distance &&
           std::abs(wrapped(p.yaw - excluded_->pose.yaw)) < excluded_->yaw;
  }

  const LikelihoodField& field_;
  const SearchWindow& window_;
  double yaw_step_;
  const std::optional<Excluded>& excluded_;
  std::size_t count_;
  int half_columns_, half_rows_, half_yaws_;
  std::vector<Eigen::Array2i> cells_;  ///< of each point under each yaw, at the window's low corner
  int best_sum_ = 0;
  std::optional<Branch> found_;
};

}  // namespace

std::optional<Peak> best_pose(const LikelihoodField& field, const std::vector<float>& x,
                              const std::vector<float>& y, const SearchWindow& window,
                              double yaw_step, double least,
                              const std::optional<Excluded>& excluded) {
  if (x.empty()) return std::nullopt;
  return Search(field, x, y, window, yaw_step, excluded).best(least);
}

double score_of(const LikelihoodField& field, const std::vector<float>& x,
                const std::vector<float>& y, const PlanarPose& pose) {
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const auto cell = field.cell(pose.x + c * x[k] - s * y[k], pose.y + s * x[k] + c * y[k]);
    sum += field.value(0, cell.x(), cell.y());
  }
  return x.empty() ? 0 : static_cast<double>(sum) / (255.0 * static_cast<double>(x.size()));
}

PlanarPose between_cells(const LikelihoodField& field, const std::vector<float>& x,
                         const std::vector<float>& y, const PlanarPose& peak, double yaw_step,
                         const Prior& prior) {
  const auto score = [&](const PlanarPose& pose) {
    return score_of(field, x, y, pose) - prior.lost(pose);
  };
  const double middle = score(peak);
  const auto top = [&](const PlanarPose& before, const PlanarPose& after) {
    const double low = score(before), high = score(after);
    const double bend = low - 2 * middle + high;
    return bend < -1e-9 ? std::clamp(0.5 * (low - high) / bend, -0.5, 0.5) : 0.0;
  };
  const double d = field.resolution();
  PlanarPose result = peak;
  result.x += d * top({peak.x - d, peak.y, peak.yaw}, {peak.x + d, peak.y, peak.yaw});
  result.y += d * top({peak.x, peak.y - d, peak.yaw}, {peak.x, peak.y + d, peak.yaw});
  result.yaw +=
      yaw_step * top({peak.x, peak.y, peak.yaw - yaw_step}, {peak.x, peak.y, peak.yaw + yaw_step});
  return result;
}

double yaw_step_for(const std::vector<float>& x, const std::vector<float>& y, double resolution) {
  std::vector<float> squares(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) squares[k] = x[k] * x[k] + y[k] * y[k];
  if (squares.empty()) return 0.1;
  const auto nine = squares.begin() + static_cast<std::ptrdiff_t>(9 * (squares.size() - 1) / 10);
  std::nth_element(squares.begin(), nine, squares.end());
  return std::clamp(resolution / std::sqrt(std::max(*nine, 1e-6f)), 1e-3, 0.1);
}

}  // namespace plumb::planar
