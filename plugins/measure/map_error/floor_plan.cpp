#include "floor_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "plumb/data/counted.hpp"
#include "plumb/data/io/file_text.hpp"

namespace plumb::measure_map_error {

std::vector<Wall> read_plan(const std::filesystem::path& file) {
  const io::FileBytes bytes(file);
  io::Lines lines(bytes.view());
  std::vector<Wall> walls;
  for (std::string_view line; lines.next(line);) {
    std::array<double, 4> v{};
    std::size_t have = 0;
    for (auto word = io::next_word(line); !word.empty(); word = io::next_word(line), ++have) {
      if (have == 0 && word.front() == '#') break;
      double value = 0;
      if (!io::to_number(word, value) || !std::isfinite(value))
        io::refuse(file, lines.number(),
                   "expected a wall 'x1 y1 x2 y2', found " + io::in_quotes(word));
      if (have < v.size()) v[have] = value;
    }
    if (have == 0) continue;
    if (have != v.size())
      io::refuse(file, lines.number(),
                 "expected a wall 'x1 y1 x2 y2', found " + counted(have, "numbers"));
    walls.push_back({{v[0], v[1]}, {v[2], v[3]}});
  }
  if (walls.empty()) io::refuse(file, "holds no wall: give lines 'x1 y1 x2 y2' in metres");
  return walls;
}

double distance(const Wall& wall, const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = wall.b - wall.a;
  const double squared = along.squaredNorm();
  const double s = squared > 0 ? std::clamp((p - wall.a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (p - wall.a - s * along).norm();
}

WallTree::WallTree(std::vector<Wall> walls) : walls_(std::move(walls)) {
  nodes_.reserve(walls_.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(walls_.size()));
}

void WallTree::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()),
                 high = -low;
  for (std::uint32_t k = first; k < first + count; ++k) {
    low = low.min(walls_[k].a.array()).min(walls_[k].b.array());
    high = high.max(walls_[k].a.array()).max(walls_[k].b.array());
  }
  nodes_[node] = {low, high, first, count};
  if (count <= 4) return;
  const int axis = (high - low).x() >= (high - low).y() ? 0 : 1;
  const auto begin = walls_.begin() + first, middle = begin + count / 2;
  std::nth_element(begin, middle, begin + count, [axis](const Wall& p, const Wall& q) {
    return p.a[axis] + p.b[axis] < q.a[axis] + q.b[axis];
  });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = children;
  nodes_[node].count = 0;
  build(children, first, count / 2);
  build(children + 1, first + count / 2, count - count / 2);
}

double WallTree::to_box(std::uint32_t node, const Eigen::Vector2d& p) const {
  const Eigen::Array2d outside =
      (nodes_[node].low - p.array()).max(p.array() - nodes_[node].high).max(0.0);
  return outside.matrix().norm();
}

void WallTree::search(std::uint32_t node, const Eigen::Vector2d& p, double& best) const {
  const Node& here = nodes_[node];
  for (std::uint32_t k = here.first; k < here.first + here.count; ++k)
    best = std::min(best, distance(walls_[k], p));
  if (here.count > 0) return;
  const double left = to_box(here.first, p), right = to_box(here.first + 1, p);
  const std::uint32_t nearer = left <= right ? here.first : here.first + 1;
  const std::uint32_t farther = left <= right ? here.first + 1 : here.first;
  if (std::min(left, right) < best) search(nearer, p, best);
  if (std::max(left, right) < best) search(farther, p, best);
}

double WallTree::distance_to(const Eigen::Vector2d& p) const {
  double best = std::numeric_limits<double>::infinity();
  search(0, p, best);
  return best;
}

}  // namespace plumb::measure_map_error
