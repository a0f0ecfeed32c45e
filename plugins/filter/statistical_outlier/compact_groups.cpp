#include "compact_groups.hpp"

#include <algorithm>
#include <array>

namespace plumb::filter_statistical_outlier {
namespace {

struct Item {
  std::array<float, 3> at;
  std::uint32_t index;
};

void part(Item* first, Item* last, std::size_t size) {
  const auto n = static_cast<std::size_t>(last - first);
  if (n <= size) return;
  std::array<float, 3> least = first->at, most = first->at;
  for (const Item* item = first; item != last; ++item)
    for (std::size_t c = 0; c < 3; ++c) {
      least[c] = std::min(least[c], item->at[c]);
      most[c] = std::max(most[c], item->at[c]);
    }
  std::size_t axis = 0;
  for (std::size_t c = 1; c < 3; ++c)
    if (most[c] - least[c] > most[axis] - least[axis]) axis = c;
  Item* middle = first + (n / 2 + size - 1) / size * size;
  if (middle == last) middle -= size;
  std::nth_element(first, middle, last, [axis](const Item& a, const Item& b) {
    return a.at[axis] < b.at[axis] || (a.at[axis] == b.at[axis] && a.index < b.index);
  });
  part(first, middle, size);
  part(middle, last, size);
}

}  // namespace

std::vector<std::uint32_t> compact_groups(const Cloud& cloud, std::size_t size) {
  std::vector<Item> items(cloud.size());
  for (std::size_t k = 0; k < items.size(); ++k)
    items[k] = {{cloud.x[k], cloud.y[k], cloud.z[k]}, static_cast<std::uint32_t>(k)};
  part(items.data(), items.data() + items.size(), size);
  std::vector<std::uint32_t> order(items.size());
  for (std::size_t k = 0; k < items.size(); ++k) order[k] = items[k].index;
  return order;
}

}  // namespace plumb::filter_statistical_outlier
