/// Lays a city out along a path: first the houses, then what stands between them, then what stands
/// on the street.

#include <cmath>
#include <limits>
#include <optional>

#include "simulate/random.hpp"
#include "simulate/street.hpp"
#include "simulate/world.hpp"

namespace plumb::simulate {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

class Builder {
 public:
  Builder(const Street& street, const Ground& ground, float half_width, std::size_t repeat,
          std::uint64_t seed)
      : street_(street),
        ground_(ground),
        half_width_(half_width),
        repeat_(repeat),
        random_(mix(seed)) {}

  void build() {
    for (const float side : {1.0f, -1.0f}) front_row(side);
    for (const float side : {1.0f, -1.0f}) back_row(side);
    for (const float side : {1.0f, -1.0f}) fences(side);
    for (const float side : {1.0f, -1.0f}) cars(side);
    for (const float side : {1.0f, -1.0f}) trees(side);
    for (const float side : {1.0f, -1.0f}) poles(side);
    for (const float side : {1.0f, -1.0f}) small_things(side);
  }

  std::vector<Primitive> primitives;
  std::vector<Facade> facades;

 private:
  float uniform(double low, double high) { return static_cast<float>(random_.uniform(low, high)); }
  bool chance(double share) { return random_.chance(share); }

  /// A free rectangle of the given half lengths beside node k, its near edge `lateral` from the
  /// node's lane or as little more as keeps `clearance` from every lane; taken at once.
  std::optional<Footprint> place(std::size_t k, float side, const Vector2f& half, float lateral,
                                 float clearance, float tolerance = 0) {
    const Street::Node& node = street_.nodes()[k];
    const Vector2f out = side * Vector2f(-node.along.y(), node.along.x());
    for (float shift = 0; shift <= 5; shift += 0.5f) {
      const Footprint r{node.at + (lateral + shift + half.y()) * out, node.along, half};
      if (!street_.clear(r, clearance)) continue;
      if (!plots_.free(r, tolerance)) return std::nullopt;
      plots_.take(r);
      return r;
    }
    return std::nullopt;
  }

  /// Visits the nodes of streets not yet laid out; visit(k) returns how far to go on [m].
  template <class Visit>
  void march(Visit visit) {
    const auto& nodes = street_.nodes();
    const std::uint64_t call = ++marches_;
    std::size_t block = std::numeric_limits<std::size_t>::max();
    for (double s = 0; s < static_cast<double>(nodes.size());) {
      auto k = static_cast<std::size_t>(s);
      if (repeat_ > 0 && k / repeat_ != block) {  // a block begins like the one before
        block = k / repeat_;
        s = static_cast<double>(k = block * repeat_);
        random_ = Random(mix(random_seed_, call));
      }
      if (repeat_ > 0 &&
          repeat_ - k % repeat_ <= block_gap) {  // nothing reaches over into the next
        s = static_cast<double>((block + 1) * repeat_);
        continue;
      }
      s += nodes[k].repeated ? 1.0 : std::max(0.5, static_cast<double>(visit(k)));
    }
  }
  /// The street's character, the same over some 60 m: 0 to 1.
  double character(std::size_t k, float side, std::uint64_t of) {
    if (repeat_ > 0) k %= repeat_;
    return static_cast<double>(unit(mix(of, k / 60, side > 0 ? 1 : 2) ^ random_seed_));
  }

  float ground_at(const Footprint& r) const { return ground_.height(r.centre.x(), r.centre.y()); }

  /// A box on the rectangle from height z0 to z1 [m].
  Primitive& box(const Footprint& r, float z0, float z1, float reflectance) {
    Primitive p;
    p.reflectance = reflectance;
    p.cosine = r.along.x(), p.sine = r.along.y();
    p.centre = {r.centre.x(), r.centre.y(), 0.5f * (z0 + z1)};
    p.half = {r.half.x(), r.half.y(), 0.5f * (z1 - z0)};
    return primitives.emplace_back(p);
  }
  void round(Primitive::Kind kind, const Vector3f& centre, const Vector3f& half,
             float reflectance) {
    Primitive p;
    p.kind = kind, p.reflectance = reflectance, p.centre = centre, p.half = half;
    primitives.push_back(p);
  }

  void front_row(float side);
  void back_row(float side);
  void house(const Footprint& plot, float side, float height);
  void fences(float side);
  void cars(float side);
  void trees(float side);
  void poles(float side);
  void small_things(float side);

  const Street& street_;
  const Ground& ground_;
  static constexpr std::size_t block_gap = 24;  ///< [m] as wide as the widest house

  float half_width_;
  std::size_t repeat_;  ///< nodes (metres) after which streets look the same again; 0: never
  std::uint64_t marches_ = 0;
  Random random_;
  std::uint64_t random_seed_ = random_.next();
  Plots plots_;
};

void Builder::front_row(float side) {
  march([&](std::size_t k) {
    const float setback = chance(0.7) ? uniform(0, 0.6) : uniform(0.6, 3.5);
    for (float width = uniform(8, 22); width > 6; width *= 0.65f) {
      const std::size_t middle = k + static_cast<std::size_t>(0.5f * width);
      if (middle >= street_.nodes().size()) continue;
      const Vector2f half(0.5f * width, uniform(4, 7));
      const auto plot = place(middle, side, half, half_width_ + setback, half_width_, 0.4f);
      if (!plot) continue;
      house(*plot, side, uniform(6, 19));
      return width + (chance(0.55) ? 0.0f : uniform(1.5, 9));
    }
    return 2.0f;
  });
}

void Builder::back_row(float side) {
  march([&](std::size_t k) {
    const Vector2f half(uniform(6, 16), uniform(5, 8));
    if (chance(0.5))
      if (const auto plot = place(k, side, half, half_width_ + uniform(18, 30), half_width_ + 4))
        house(*plot, side, uniform(8, 26));
    return uniform(20, 45);
  });
}

void Builder::house(const Footprint& plot, float side, float height) {
  const float base = ground_at(plot);
  const float wall = uniform(0.25, 0.7);
  Facade f;
  f.seed = random_.next();
  f.base = base + 0.1f;
  f.ground_floor = uniform(3.0, 4.2);
  f.floor = uniform(2.7, 3.3);
  f.bay = uniform(2.1, 4.4);
  f.width = uniform(0.9, 1.5);
  f.height = uniform(1.3, 2.0);
  f.depth = uniform(0.12, 0.4);
  box(plot, base - 4, base + height, wall).facade = static_cast<std::int32_t>(facades.size());
  facades.push_back(f);

  // What stands out towards the street; `plot` has the street on the other side of its normal.
  const Vector2f to_street = -side * Vector2f(-plot.along.y(), plot.along.x());
  const Vector2f front = plot.centre + plot.half.y() * to_street;
  const auto part = [&](float u, float width, float reach, float z0, float z1, float reflectance) {
    const Footprint r{front + u * plot.along + 0.5f * reach * to_street,
                      plot.along,
                      {0.5f * width, 0.5f * reach + 0.05f}};
    box(r, base + z0, base + z1, reflectance);
  };
  const float end = plot.half.x() - 1;
  const float second = 0.1f + f.ground_floor;
  if (chance(0.5)) part(0, 2 * plot.half.x(), 0.35f, height - 0.4f, height, wall);  // cornice
  if (chance(0.35))
    part(uniform(-end, end), uniform(1.8, 3), uniform(0.5, 1), second, height - 1, wall);  // oriel
  if (chance(0.3))
    part(uniform(-end, end), uniform(2, 3.2), uniform(0.4, 0.9), -1, second, wall);  // bay window
  for (int k = 0; k < 2; ++k)
    if (chance(0.5))
      part(uniform(-end, end), uniform(1.2, 2.2), uniform(0.4, 1.1), -1, uniform(0.3, 0.8),
           0.3f);  // steps
  const int balconies = chance(0.4) ? 1 + static_cast<int>(uniform(0, 4)) : 0;
  for (int k = 0; k < balconies; ++k) {
    const float z = second + f.floor * std::floor(uniform(0, 3));
    if (z + 1.1f < height)
      part(uniform(-end, end), uniform(1.8, 3.5), uniform(0.8, 1.3), z, z + 1.1f, 0.35f);
  }
  for (int k = 0; k < 3; ++k)  // pilasters and drain pipes
    if (chance(0.4))
      part(uniform(-end - 0.7, end + 0.7), uniform(0.2, 0.6), uniform(0.12, 0.35), -1,
           height - 0.5f, wall);
}

void Builder::fences(float side) {
  march([&](std::size_t k) {
    const float length = uniform(1.5, 7);
    const bool hedge = chance(0.4);
    const Vector2f half(0.5f * length, hedge ? uniform(0.3, 0.6) : 0.12f);
    if (chance(0.6))
      if (const auto r = place(k, side, half, half_width_ + uniform(0, 1), half_width_ - 0.2f)) {
        const float base = ground_at(*r);
        box(*r, base - 1, base + uniform(0.7, 2.2), hedge ? 0.45f : 0.35f);
      }
    return length + uniform(0, 3);
  });
}

void Builder::cars(float side) {
  march([&](std::size_t k) {
    if (!chance(0.15 + 0.7 * character(k, side, 1))) return uniform(5, 9);
    const bool van = chance(0.18);
    const Vector2f half(van ? uniform(2.4, 2.9) : uniform(1.9, 2.4),
                        van ? 1.0f : uniform(0.8, 0.95));
    const auto r = place(k, side, half, half_width_ - uniform(3.8, 4.1), 2.4f);
    if (!r) return 3.0f;
    const float base = ground_at(*r), paint = uniform(0.1, 0.8);
    const float sill = base + 0.22f;
    if (van) {
      box(*r, sill, base + uniform(1.9, 2.5), paint);
    } else {
      const float bonnet = base + uniform(0.8, 0.95);
      box(*r, sill, bonnet, paint);
      Footprint cabin = *r;
      cabin.half.x() *= uniform(0.45, 0.65);
      cabin.half.y() *= 0.85f;
      cabin.centre += (chance(0.5) ? 1.0f : -1.0f) * uniform(0.05, 0.5) * r->along;
      box(cabin, bonnet, bonnet + uniform(0.5, 0.7), 0.2f);
    }
    for (const float end : {-0.62f, 0.62f}) {  // axles with wheels, seen as one dark block
      Footprint wheel{
          r->centre + end * r->half.x() * r->along, r->along, {0.3f, r->half.y() * 0.96f}};
      box(wheel, base - 0.1f, base + 0.45f, 0.08f);
    }
    return 2 * half.x() + uniform(0.6, 3);
  });
}

void Builder::trees(float side) {
  march([&](std::size_t k) {
    if (!chance(character(k, side, 2))) return uniform(6, 12);
    const float radius = uniform(0.1, 0.32);
    const auto r = place(k, side, {radius, radius}, half_width_ - uniform(1.0, 1.5), 2.8f);
    if (!r) return 3.0f;
    const float base = ground_at(*r), trunk = uniform(2.0, 3.5), size = uniform(0.8, 1.8);
    round(Primitive::Kind::cylinder, {r->centre.x(), r->centre.y(), base + 0.5f * trunk},
          {radius, radius, 0.5f * trunk + 0.5f}, 0.3f);
    const int lobes = 4 + static_cast<int>(uniform(0, 4));
    for (int n = 0; n < lobes; ++n) {
      const float a = uniform(0.5, 1.0) * size;
      round(Primitive::Kind::ellipsoid,
            {r->centre.x() + 0.7f * size * uniform(-1, 1),
             r->centre.y() + 0.7f * size * uniform(-1, 1), base + trunk + size * uniform(0.1, 1.6)},
            {a, a, a * uniform(0.7, 1.1)}, 0.5f);
    }
    return uniform(5, 14);
  });
}

void Builder::poles(float side) {
  march([&](std::size_t k) {
    const float radius = uniform(0.05, 0.13);
    const bool lamp = chance(0.5);
    const auto r = place(k, side, {radius, radius}, half_width_ - uniform(1.3, 1.9), 2.8f);
    if (!r) return 2.0f;
    const float base = ground_at(*r), top = lamp ? uniform(5, 8) : uniform(2.2, 3.2);
    round(Primitive::Kind::cylinder, {r->centre.x(), r->centre.y(), base + 0.5f * top},
          {radius, radius, 0.5f * top + 0.3f}, 0.4f);
    const Vector2f across(-r->along.y(), r->along.x());
    if (lamp) {
      box({r->centre - side * 0.8f * across, across, {0.9f, 0.1f}}, base + top, base + top + 0.15f,
          0.4f);
    } else {
      box({r->centre, across, {uniform(0.25, 0.45), 0.03f}}, base + top - uniform(0.4, 0.8),
          base + top, 0.9f);
    }
    return uniform(9, 30);
  });
}

void Builder::small_things(float side) {
  march([&](std::size_t k) {
    const Vector2f half(uniform(0.2, 0.9), uniform(0.2, 0.5));
    if (const auto r = place(k, side, half, half_width_ - uniform(0.9, 1.9), 2.8f)) {
      const float base = ground_at(*r);
      if (chance(0.7)) {  // bins, boxes, planters
        box(*r, base - 0.3f, base + uniform(0.5, 1.4), uniform(0.2, 0.6));
      } else {  // advertising columns, bollards
        const float radius = std::min(half.x(), half.y()), top = uniform(0.8, 2.6);
        round(Primitive::Kind::cylinder, {r->centre.x(), r->centre.y(), base + 0.5f * top},
              {radius, radius, 0.5f * top + 0.2f}, 0.5f);
      }
    }
    return uniform(6, 22);
  });
}

}  // namespace

World build_city(const std::vector<Eigen::Vector3d>& path, double sensor_height,
                 double street_width, double alike, std::uint64_t seed) {
  const Eigen::Vector3d origin = path.front();
  std::vector<Vector3f> local;
  local.reserve(path.size());
  for (const auto& p : path)
    local.push_back((p - origin - Eigen::Vector3d(0, 0, sensor_height)).cast<float>());
  const Street street(local);
  std::vector<Vector3f> lane;
  lane.reserve(street.nodes().size());
  for (const auto& node : street.nodes()) lane.emplace_back(node.at.x(), node.at.y(), node.z);

  const auto half_street = static_cast<float>(0.5 * street_width);
  Ground ground = ground_under(lane, half_street - 2, 70, seed, alike > 0 ? 0.0f : 1.0f);
  Builder builder(street, ground, half_street, static_cast<std::size_t>(alike), seed);
  builder.build();
  return {origin, std::move(ground), std::move(builder.primitives), std::move(builder.facades)};
}

}  // namespace plumb::simulate
