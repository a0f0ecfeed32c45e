#include "simulate/floor_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace plumb::simulate {
namespace {

using Eigen::Vector2d;

bool holds(const Rectangle& r, double x, double y) {
  return r.x0 < x && x < r.x1 && r.y0 < y && y < r.y1;
}

/// All coordinates of edges, ascending, each once.
std::vector<double> cuts(const std::vector<Rectangle>& a, const std::vector<Rectangle>& b,
                         double Rectangle::*low, double Rectangle::*high) {
  std::vector<double> all;
  for (const auto* list : {&a, &b})
    for (const Rectangle& r : *list) all.insert(all.end(), {r.*low, r.*high});
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Borders met when going along lines of cells: `differ(line, k)` says whether the cells on both
/// sides of the line differ at its k-th stretch; runs of them become one wall each.
template <class Differ, class Emit>
void runs(std::size_t lines, std::size_t stretches, Differ differ, Emit emit) {
  for (std::size_t line = 0; line < lines; ++line) {
    std::optional<std::size_t> begin;
    for (std::size_t k = 0; k <= stretches; ++k) {
      const bool border = k < stretches && differ(line, k);
      if (border && !begin) begin = k;
      if (!border && begin) emit(line, *begin, k), begin.reset();
    }
  }
}

}  // namespace

void FloorPlan::box(const Vector2d& centre, const Vector2d& size, double heading) {
  const Vector2d u(std::cos(heading), std::sin(heading)), v(-u.y(), u.x());
  const Vector2d l = 0.5 * size.x() * u, w = 0.5 * size.y() * v;
  const Vector2d corners[] = {centre - l - w, centre + l - w, centre + l + w, centre - l + w};
  for (int k = 0; k < 4; ++k) loose_.push_back({corners[k], corners[(k + 1) % 4]});
}

void FloorPlan::column(const Vector2d& centre, double radius) {
  constexpr int sides = 12;
  const auto corner = [&](int k) -> Vector2d {
    const double angle = 2 * std::numbers::pi * (k % sides) / sides;
    return centre + radius * Vector2d(std::cos(angle), std::sin(angle));
  };
  for (int k = 0; k < sides; ++k) loose_.push_back({corner(k), corner(k + 1)});
}

bool FloorPlan::is_floor(const Vector2d& point) const {
  const auto in = [&](const Rectangle& r) { return holds(r, point.x(), point.y()); };
  return std::any_of(floors_.begin(), floors_.end(), in) &&
         std::none_of(solids_.begin(), solids_.end(), in);
}

std::vector<Wall> FloorPlan::walls() const {
  const std::vector<double> xs = cuts(floors_, solids_, &Rectangle::x0, &Rectangle::x1),
                            ys = cuts(floors_, solids_, &Rectangle::y0, &Rectangle::y1);
  if (xs.empty()) return loose_;
  const std::size_t nx = xs.size() - 1, ny = ys.size() - 1;
  std::vector<char> floor(nx * ny, 0);
  const auto paint = [&](const Rectangle& r, char value) {
    const auto at = [](const std::vector<double>& v, double c) {
      return static_cast<std::size_t>(std::lower_bound(v.begin(), v.end(), c) - v.begin());
    };
    for (std::size_t i = at(xs, r.x0); i < at(xs, r.x1); ++i)
      for (std::size_t j = at(ys, r.y0); j < at(ys, r.y1); ++j) floor[i * ny + j] = value;
  };
  for (const Rectangle& r : floors_) paint(r, 1);
  for (const Rectangle& r : solids_) paint(r, 0);
  const auto cell = [&](std::size_t i, std::size_t j) {  // 1-based; 0 and n + 1 are outside
    return i >= 1 && i <= nx && j >= 1 && j <= ny && floor[(i - 1) * ny + j - 1];
  };

  std::vector<Wall> found;
  runs(
      ny + 1, nx,
      [&](std::size_t j, std::size_t i) { return cell(i + 1, j) != cell(i + 1, j + 1); },
      [&](std::size_t j, std::size_t from, std::size_t to) {
        found.push_back({{xs[from], ys[j]}, {xs[to], ys[j]}});
      });
  runs(
      nx + 1, ny,
      [&](std::size_t i, std::size_t j) { return cell(i, j + 1) != cell(i + 1, j + 1); },
      [&](std::size_t i, std::size_t from, std::size_t to) {
        found.push_back({{xs[i], ys[from]}, {xs[i], ys[to]}});
      });
  found.insert(found.end(), loose_.begin(), loose_.end());
  return found;
}

double clearance(const std::vector<Wall>& walls, const Vector2d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const Wall& wall : walls) {
    const Vector2d along = wall.b - wall.a;
    const double share = std::clamp((point - wall.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (wall.a + share * along - point).norm());
  }
  return least;
}

}  // namespace plumb::simulate
