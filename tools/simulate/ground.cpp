#include "simulate/ground.hpp"

#include <algorithm>
#include <cmath>

namespace plumb::simulate {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int block = 8;  // cells along a block's edge
constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float reflectance = 0.2f;

/// Visits the cells of a grid that the line a + t d crosses for t in [t0, t1], in order, as
/// visit(i, j, enter, leave), until one returns true. The line must lie inside the grid.
template <class Visit>
bool walk(const Vector2f& a, const Vector2f& d, float cell, int columns, int rows, float t0,
          float t1, Visit visit) {
  const auto index = [cell](float v, int n) {
    return std::clamp(static_cast<int>(std::floor(v / cell)), 0, n - 1);
  };
  int i = index(a.x() + t0 * d.x(), columns), j = index(a.y() + t0 * d.y(), rows);
  const int step_i = d.x() > 0 ? 1 : -1, step_j = d.y() > 0 ? 1 : -1;
  const float per_x = d.x() == 0 ? infinite : 1 / d.x();
  const float per_y = d.y() == 0 ? infinite : 1 / d.y();
  const auto next_x = [&] {
    return d.x() == 0 ? infinite : (static_cast<float>(i + (step_i > 0)) * cell - a.x()) * per_x;
  };
  const auto next_y = [&] {
    return d.y() == 0 ? infinite : (static_cast<float>(j + (step_j > 0)) * cell - a.y()) * per_y;
  };
  float enter = t0, tx = next_x(), ty = next_y();
  while (true) {
    const float leave = std::min({tx, ty, t1});
    if (leave > enter && visit(i, j, enter, leave)) return true;
    if (leave >= t1) return false;
    enter = std::max(enter, leave);
    if (tx <= ty) {
      i += step_i;
      if (i < 0 || i >= columns) return false;
      tx = next_x();
    } else {
      j += step_j;
      if (j < 0 || j >= rows) return false;
      ty = next_y();
    }
  }
}

}  // namespace

Ground::Ground(const Vector2f& low, float cell, int columns, int rows, std::vector<float> heights)
    : low_(low), cell_(cell), columns_(columns), rows_(rows), heights_(std::move(heights)) {
  block_columns_ = (columns - 2) / block + 1;
  const int block_rows = (rows - 2) / block + 1;
  block_top_.assign(static_cast<std::size_t>(block_columns_) * static_cast<std::size_t>(block_rows),
                    -infinite);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      // A sample on the edge between blocks belongs to both.
      for (const int bj : {std::max(0, j - 1) / block, std::min(j, rows - 2) / block})
        for (const int bi : {std::max(0, i - 1) / block, std::min(i, columns - 2) / block}) {
          float& top = block_top_[static_cast<std::size_t>(bj * block_columns_ + bi)];
          top = std::max(top, at(i, j));
        }
}

float Ground::height(float x, float y) const {
  const float gx = std::clamp((x - low_.x()) / cell_, 0.0f, static_cast<float>(columns_ - 1));
  const float gy = std::clamp((y - low_.y()) / cell_, 0.0f, static_cast<float>(rows_ - 1));
  const int i = std::min(static_cast<int>(gx), columns_ - 2);
  const int j = std::min(static_cast<int>(gy), rows_ - 2);
  const float u = gx - static_cast<float>(i), v = gy - static_cast<float>(j);
  const float h00 = at(i, j), h11 = at(i + 1, j + 1);
  if (u >= v) return h00 + u * (at(i + 1, j) - h00) + v * (h11 - at(i + 1, j));
  return h00 + v * (at(i, j + 1) - h00) + u * (h11 - at(i, j + 1));
}

bool Ground::intersect_cell(const Ray& ray, int i, int j, float t0, float t1, Hit& hit) const {
  const float h00 = at(i, j), h10 = at(i + 1, j), h01 = at(i, j + 1), h11 = at(i + 1, j + 1);
  const float z0 = ray.origin.z() + t0 * ray.direction.z();
  const float z1 = ray.origin.z() + t1 * ray.direction.z();
  if (std::min(z0, z1) > std::max(std::max(h00, h10), std::max(h01, h11))) return false;
  const float corner_x = low_.x() + cell_ * static_cast<float>(i);
  const float corner_y = low_.y() + cell_ * static_cast<float>(j);
  const float u = (ray.origin.x() - corner_x) / cell_, v = (ray.origin.y() - corner_y) / cell_;
  const float du = ray.direction.x() / cell_, dv = ray.direction.y() / cell_;

  // The diagonal u = v cuts the way into at most two parts, each above one triangle.
  const float diagonal = du == dv ? infinite : (v - u) / (du - dv);
  const bool cut = diagonal > t0 && diagonal < t1;
  const float ends[3] = {t0, cut ? diagonal : t1, t1};
  for (int k = 0; k < (cut ? 2 : 1); ++k) {
    const float a = ends[k], b = ends[k + 1], middle = 0.5f * (a + b);
    const bool lower = u + middle * du >= v + middle * dv;
    const float slope_u = lower ? h10 - h00 : h11 - h01;
    const float slope_v = lower ? h11 - h10 : h01 - h00;
    const auto above = [&](float t) {
      return ray.origin.z() + t * ray.direction.z() - h00 - (u + t * du) * slope_u -
             (v + t * dv) * slope_v;
    };
    const float at_b = above(b);
    if (at_b > 0) continue;
    const float at_a = std::max(0.0f, above(a));
    const float t = at_a > 0 ? a + (b - a) * (at_a / (at_a - at_b)) : a;
    if (t >= hit.t) return true;
    hit = {t, Vector3f(-slope_u, -slope_v, cell_).normalized(), reflectance};
    return true;
  }
  return false;
}

bool Ground::intersect(const Ray& ray, Hit& hit) const {
  if (columns_ < 2) return false;
  const Vector2f a = ray.origin.head<2>() - low_, d = ray.direction.head<2>();
  float t0 = 0, t1 = std::min(hit.t, 1e6f);
  const Vector2f size(cell_ * static_cast<float>(columns_ - 1),
                      cell_ * static_cast<float>(rows_ - 1));
  for (int k = 0; k < 2; ++k) {  // clip to the grid
    if (d[k] == 0) {
      if (a[k] < 0 || a[k] > size[k]) return false;
      continue;
    }
    const float to_low = -a[k] / d[k], to_high = (size[k] - a[k]) / d[k];
    t0 = std::max(t0, std::min(to_low, to_high));
    t1 = std::min(t1, std::max(to_low, to_high));
  }
  if (t0 >= t1) return false;
  const float before = hit.t;
  const int block_rows = static_cast<int>(block_top_.size()) / block_columns_;
  walk(a, d, cell_ * block, block_columns_, block_rows, t0, t1,
       [&](int bi, int bj, float enter, float leave) {
         const float z =
             ray.origin.z() + std::min(enter * ray.direction.z(), leave * ray.direction.z());
         if (z > block_top_[static_cast<std::size_t>(bj * block_columns_ + bi)]) return false;
         return walk(a, d, cell_, columns_ - 1, rows_ - 1, enter, leave,
                     [&](int i, int j, float in, float out) {
                       return intersect_cell(ray, i, j, in, out, hit);
                     });
       });
  return hit.t < before;
}

}  // namespace plumb::simulate
