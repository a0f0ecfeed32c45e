#include "jet.hpp"

#include <CGAL/Monge_via_jet_fitting.h>

#include <algorithm>
#include <utility>

#include "shared/cgal/adapter.hpp"

namespace plumb::estimate_normals_jet {

Eigen::Vector3f jet_normal(const std::vector<Eigen::Vector3f>& points, const JetOptions& options) {
  const std::size_t degree = options.degree;
  if (points.size() < (degree + 1) * (degree + 2) / 2 ||
      neighbourhood::plane_normal(points.data(), points.size(), options.min_width,
                                  options.max_thickness)
          .isZero())
    return Eigen::Vector3f::Zero();
  std::vector<cgal::Point> copies;
  copies.reserve(points.size());
  for (const Eigen::Vector3f& p : points) copies.push_back(cgal::point_of(p));
  CGAL::Monge_via_jet_fitting<cgal::Kernel> fit;
  const auto form = fit(copies.begin(), copies.end(), degree, 1);  // no more than the normal
  const Eigen::Vector3d normal = cgal::eigen_of(form.normal_direction());
  if (!normal.allFinite() || normal.isZero()) return Eigen::Vector3f::Zero();
  return normal.normalized().cast<float>();
}

std::size_t jet_normals(Cloud& cloud, const SearchTree& tree, const neighbourhood::Bounds& bounds,
                        const JetOptions& options,
                        const std::function<Eigen::Vector3f(std::size_t)>& origin,
                        Context& context) {
  return neighbourhood::write_normals(
      cloud, tree, bounds, origin, context, [&](const std::vector<Eigen::Vector3f>& neighbours) {
        auto points = neighbours;  // among them, at the origin, the point itself
        const auto self = std::ranges::find_if(points, [](const auto& p) { return p.isZero(0); });
        if (self != points.end()) std::swap(points.front(), *self);
        return jet_normal(points, options);
      });
}

}  // namespace plumb::estimate_normals_jet
