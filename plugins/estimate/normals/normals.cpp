#include "normals.hpp"

#include "shared/planar/line_normal.hpp"

namespace plumb::estimate_normals {

std::size_t estimate_normals(Cloud& cloud, const SearchTree& tree, const Neighbourhood& of,
                             const std::function<Eigen::Vector3f(std::size_t)>& origin,
                             Context& context) {
  return neighbourhood::write_normals(
      cloud, tree, {of.radius, of.most}, origin, context,
      [&](const std::vector<Eigen::Vector3f>& points) {
        return of.planar
                   ? planar::line_normal(points.data(), points.size())
                   : plane_normal(points.data(), points.size(), of.min_width, of.max_thickness);
      });
}

}  // namespace plumb::estimate_normals
