#include "hilbert.hpp"

#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <numeric>

#include "shared/cgal/adapter.hpp"

namespace plumb::filter_spatial_sort {

std::vector<std::uint32_t> hilbert_order(const Cloud& cloud) {
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto first_left_out = std::stable_partition(
      order.begin(), order.end(), [&](std::size_t k) { return cloud.point(k).allFinite(); });
  if (first_left_out != order.begin()) {
    const std::vector<cgal::Point> points = cgal::points_of(cloud);
    using Map = CGAL::Pointer_property_map<cgal::Point>::const_type;
    using Traits = CGAL::Spatial_sort_traits_adapter_3<cgal::Kernel, Map>;
    // Not CGAL::spatial_sort, which puts coarse samples first, for who inserts points one by one.
    CGAL::hilbert_sort<CGAL::Sequential_tag>(order.begin(), first_left_out,
                                             Traits(CGAL::make_property_map(points)));
  }
  return {order.begin(), order.end()};
}

}  // namespace plumb::filter_spatial_sort
