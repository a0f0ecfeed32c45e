#include "plumb/slam/geometry/search_tree.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace plumb {
namespace {

using Neighbour = SearchTree::Neighbour;

constexpr std::size_t lanes = 8;
constexpr std::size_t leaf_points = 32;
constexpr float farthest = std::numeric_limits<float>::max();

/// Eight points side by side, so that one instruction treats all of them. Unused places lie at
/// infinity.
struct alignas(32) Block {
  float x[lanes], y[lanes], z[lanes];
  std::uint32_t index[lanes];
};

/// Bit j tells whether point j of `block` lies within `worst` of `q`; then its squared distance is
/// in `squared`.
inline unsigned compare(const Block& block, const Eigen::Vector3f& q, float worst, float* squared) {
#if defined(__AVX__)
  const __m256 dx = _mm256_sub_ps(_mm256_load_ps(block.x), _mm256_set1_ps(q.x()));
  const __m256 dy = _mm256_sub_ps(_mm256_load_ps(block.y), _mm256_set1_ps(q.y()));
  const __m256 dz = _mm256_sub_ps(_mm256_load_ps(block.z), _mm256_set1_ps(q.z()));
  const __m256 d = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)),
                                 _mm256_mul_ps(dz, dz));
  _mm256_store_ps(squared, d);
  return static_cast<unsigned>(
      _mm256_movemask_ps(_mm256_cmp_ps(d, _mm256_set1_ps(worst), _CMP_LE_OQ)));
#else
  unsigned mask = 0;
  for (std::size_t j = 0; j < lanes; ++j) {
    const float dx = block.x[j] - q.x(), dy = block.y[j] - q.y(), dz = block.z[j] - q.z();
    squared[j] = (dx * dx + dy * dy) + dz * dz;
    mask |= static_cast<unsigned>(squared[j] <= worst) << j;
  }
  return mask;
#endif
}

struct Item {
  std::array<float, 3> at;
  std::uint32_t index;
};

/// An inner node parts its points at `axis`: the left ones reach up to `low`, the right ones begin
/// at `high`. The left child is the next node. A leaf (axis 3) holds the blocks from `link` to
/// before `end`.
struct Node {
  float low, high;
  std::uint32_t link;  ///< right child, or first block
  std::uint32_t end;
  std::uint32_t axis;
};

}  // namespace

struct SearchTree::Tree {
  std::vector<Node> nodes;
  std::vector<Block> blocks;
  std::array<float, 3> low{}, high{};
  std::size_t count = 0;

  void build(Item* first, Item* last) {
    const auto here = nodes.size();
    nodes.emplace_back();
    const auto n = static_cast<std::size_t>(last - first);
    if (n <= leaf_points) return fill_leaf(here, first, last);
    std::array<float, 3> least = first->at, most = first->at;
    for (const Item* item = first; item != last; ++item)
      for (int c = 0; c < 3; ++c) {
        least[c] = std::min(least[c], item->at[c]);
        most[c] = std::max(most[c], item->at[c]);
      }
    if (here == 0) low = least, high = most;
    std::uint32_t axis = 0;
    for (std::uint32_t c = 1; c < 3; ++c)
      if (most[c] - least[c] > most[axis] - least[axis]) axis = c;
    // The left half gets whole leaves, so that nearly all blocks are full.
    Item* middle = first + (n / 2 + leaf_points - 1) / leaf_points * leaf_points;
    const auto before = [axis](const Item& a, const Item& b) { return a.at[axis] < b.at[axis]; };
    std::nth_element(first, middle, last, before);
    nodes[here].high = middle->at[axis];
    nodes[here].low = std::max_element(first, middle, before)->at[axis];
    nodes[here].axis = axis;
    build(first, middle);
    nodes[here].link = static_cast<std::uint32_t>(nodes.size());
    build(middle, last);
  }

  void fill_leaf(std::size_t here, const Item* first, const Item* last) {
    if (here == 0) {
      low.fill(farthest), high.fill(-farthest);
      for (const Item* item = first; item != last; ++item)
        for (int c = 0; c < 3; ++c) {
          low[c] = std::min(low[c], item->at[c]);
          high[c] = std::max(high[c], item->at[c]);
        }
    }
    nodes[here].axis = 3;
    nodes[here].link = static_cast<std::uint32_t>(blocks.size());
    while (first != last) {
      Block block;
      for (std::size_t j = 0; j < lanes; ++j) {
        const bool used = first != last;
        block.x[j] = used ? first->at[0] : std::numeric_limits<float>::infinity();
        block.y[j] = used ? first->at[1] : std::numeric_limits<float>::infinity();
        block.z[j] = used ? first->at[2] : std::numeric_limits<float>::infinity();
        block.index[j] = used ? first->index : 0;
        first += used;
      }
      blocks.push_back(block);
    }
    nodes[here].end = static_cast<std::uint32_t>(blocks.size());
  }

  /// Shows `found` every point whose squared distance is <= found.worst, which may shrink
  /// meanwhile. A subtree is skipped if the squared distance to its box, computed by the same
  /// operations as that to a point, is greater: rounding keeps order, so no point that would count
  /// is ever skipped.
  template <class Found>
  void visit(const Eigen::Vector3f& q, Found& found) const {
    struct Later {
      std::uint32_t node;
      float bound;
      std::array<float, 3> squares;
    };
    if (count == 0) return;
    Later stack[64];
    std::size_t waiting = 0;
    Later now{0, 0, {}};
    for (int c = 0; c < 3; ++c) {
      const float off = std::max({low[c] - q[c], q[c] - high[c], 0.0f});
      now.squares[c] = off * off;
    }
    now.bound = (now.squares[0] + now.squares[1]) + now.squares[2];
    if (!(now.bound <= found.worst)) return;
    while (true) {
      const Node* node = &nodes[now.node];
      while (node->axis < 3) {
        const float to_low = q[node->axis] - node->low, to_high = node->high - q[node->axis];
        const bool left = to_low < to_high;
        const float off = std::max(left ? to_high : to_low, 0.0f);
        const auto near = left ? now.node + 1 : node->link;
        Later& later = stack[waiting];
        later.node = left ? node->link : now.node + 1;
        later.squares = now.squares;
        later.squares[node->axis] = std::max(off * off, now.squares[node->axis]);
        later.bound = (later.squares[0] + later.squares[1]) + later.squares[2];
        waiting += later.bound <= found.worst;
        now.node = near;
        node = &nodes[near];
      }
      alignas(32) float squared[lanes];
      for (auto b = node->link; b < node->end; ++b)
        for (unsigned mask = compare(blocks[b], q, found.worst, squared); mask; mask &= mask - 1) {
          const auto j = static_cast<unsigned>(std::countr_zero(mask));
          found.add({blocks[b].index[j], squared[j]});
        }
      do {
        if (waiting == 0) return;
        now = stack[--waiting];
      } while (now.bound > found.worst);
    }
  }
};

namespace {

/// The k best so far, in order.
struct KBest {
  Neighbour* out;
  std::size_t room, size = 0;
  float worst = farthest;

  void add(const Neighbour& candidate) {
    if (size == room && !(candidate < out[size - 1])) return;
    std::size_t place = size < room ? size++ : size - 1;
    for (; place > 0 && candidate < out[place - 1]; --place) out[place] = out[place - 1];
    out[place] = candidate;
    if (size == room) worst = out[size - 1].squared_distance;
  }
};

struct Best {
  float worst;
  Neighbour best{std::numeric_limits<std::uint32_t>::max(), std::numeric_limits<float>::infinity()};

  void add(const Neighbour& candidate) {
    if (!(candidate < best)) return;
    best = candidate;
    worst = candidate.squared_distance;
  }
};

struct All {
  std::vector<Neighbour>& out;
  float worst;
  void add(const Neighbour& candidate) { out.push_back(candidate); }
};

}  // namespace

SearchTree::SearchTree(const float* x, const float* y, const float* z, std::size_t count)
    : tree_(std::make_unique<Tree>()) {
  std::vector<Item> items;
  items.reserve(count);
  for (std::size_t k = 0; k < count; ++k)
    if (std::isfinite(x[k]) && std::isfinite(y[k]) && std::isfinite(z[k]))
      items.push_back({{x[k], y[k], z[k]}, static_cast<std::uint32_t>(k)});
  tree_->count = items.size();
  if (items.empty()) return;
  tree_->nodes.reserve(2 * (items.size() / leaf_points) + 2);
  tree_->blocks.reserve(items.size() / lanes + 2);
  tree_->build(items.data(), items.data() + items.size());
}

SearchTree::SearchTree(SearchTree&&) noexcept = default;
SearchTree& SearchTree::operator=(SearchTree&&) noexcept = default;
SearchTree::~SearchTree() = default;

std::size_t SearchTree::nearest(const Eigen::Vector3f& query, std::size_t k, Neighbour* out) const {
  if (k == 0) return 0;
  KBest found{out, k};
  tree_->visit(query, found);
  return found.size;
}

void SearchTree::within(const Eigen::Vector3f& query, float radius, std::vector<Neighbour>& out,
                        bool sorted) const {
  out.clear();
  if (!(radius >= 0)) return;
  All found{out, std::min(radius * radius, farthest)};
  tree_->visit(query, found);
  if (sorted) std::sort(out.begin(), out.end());
}

bool SearchTree::nearest_within(const Eigen::Vector3f& query, float max_distance,
                                Neighbour& out) const {
  if (!(max_distance >= 0)) return false;
  Best found{std::min(max_distance * max_distance, farthest)};
  tree_->visit(query, found);
  if (std::isinf(found.best.squared_distance)) return false;
  out = found.best;
  return true;
}

std::size_t SearchTree::size() const { return tree_->count; }

}  // namespace plumb
