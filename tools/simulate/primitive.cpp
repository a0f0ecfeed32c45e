#include "simulate/primitive.hpp"

#include <algorithm>
#include <cmath>

#include "simulate/random.hpp"

namespace plumb::simulate {
namespace {

using Eigen::Vector3f;

constexpr float glass = 0.25f;
constexpr float infinite = std::numeric_limits<float>::infinity();

struct Opening {
  float u0, u1, v0, v1, depth;
};

/// The opening in the cell of the facade that holds (u, v), if there is one. u runs along the side
/// from its left end, `width` long, v up from the pavement.
bool opening_at(const Facade& f, int side, float width, float top, float u, float v, Opening& o) {
  const float bays = std::floor(width / f.bay);
  if (bays < 1 || v < 0) return false;
  const float margin = 0.5f * (width - bays * f.bay);
  const float column = std::floor((u - margin) / f.bay);
  if (column < 0 || column >= bays) return false;
  const float story = v < f.ground_floor ? 0 : 1 + std::floor((v - f.ground_floor) / f.floor);
  const float low = story == 0 ? 0 : f.ground_floor + (story - 1) * f.floor;
  if (low + f.floor > top) return false;

  const auto place = static_cast<std::uint64_t>(side) * 64 + static_cast<std::uint64_t>(column);
  const std::uint64_t upright = mix(f.seed, place);  // one above the other: alike
  const std::uint64_t own = mix(f.seed, place, 1 + static_cast<std::uint64_t>(story));
  const float chance = unit(own);
  float half = 0.5f * f.width * (0.7f + 0.6f * unit(upright));
  float sill = 0.9f, height = f.height, depth = f.depth;
  if (story == 0) {
    if (chance < 0.2f) {  // door
      half = 0.6f, sill = 0, height = 2.3f, depth = 0.3f + 0.5f * unit(mix(own));
    } else if (chance < 0.35f) {  // gateway
      half = 0.42f * f.bay, sill = 0, height = 2.7f, depth = 1.0f + unit(mix(own));
    } else if (chance < 0.5f) {  // shop front
      half = 0.42f * f.bay, sill = 0.4f, height = 2.3f, depth = 0.35f;
    }
  }
  if (chance > 0.85f) return false;  // a blind bay
  const float middle = margin + (column + 0.5f) * f.bay;
  half = std::min(half, 0.45f * f.bay);
  o = {middle - half, middle + half, low + sill, low + sill + height, depth};
  return u > o.u0 && u < o.u1 && v > o.v0 && v < o.v1;
}

/// Follows a ray that met the side `axis` (0: x, 1: y) of a box at `t` into an opening, if it met
/// one. o and d are the ray in the box's own coordinates; `normal` and `t` are replaced.
bool enter_opening(const Primitive& p, const Facade& f, const Vector3f& o, const Vector3f& d,
                   int axis, float& t, Vector3f& normal) {
  const int along = 1 - axis;
  const int side = 2 * axis + (d[axis] < 0 ? 1 : 0);
  const float offset = p.centre.z() - f.base;
  float u = o[along] + t * d[along] + p.half[along];
  float v = o.z() + t * d.z() + offset;
  Opening w;
  if (!opening_at(f, side, 2 * p.half[along], p.half.z() + offset, u, v, w)) return false;

  const float back = w.depth / std::abs(d[axis]);
  const float du = d[along], dv = d.z();
  const float to_jamb = du == 0 ? infinite : ((du > 0 ? w.u1 : w.u0) - u) / du;
  const float to_lintel = dv == 0 ? infinite : ((dv > 0 ? w.v1 : w.v0) - v) / dv;
  if (back <= to_jamb && back <= to_lintel) {
    t += back;  // the pane, whose normal is the wall's
    return true;
  }
  normal.setZero();
  if (to_jamb < to_lintel) {
    t += to_jamb;
    normal[along] = du > 0 ? -1 : 1;
  } else {
    t += to_lintel;
    normal.z() = dv > 0 ? -1 : 1;
  }
  return false;
}

bool meet_box(const Primitive& p, const Facade* facade, const Vector3f& o, const Vector3f& d,
              float nearest, float& t, Vector3f& normal, bool& pane) {
  float enter = -infinite, leave = infinite;
  int axis = 0;
  for (int k = 0; k < 3; ++k) {
    if (d[k] == 0) {
      if (std::abs(o[k]) > p.half[k]) return false;
      continue;
    }
    const float inverse = 1.0f / d[k];
    const float a = (-p.half[k] - o[k]) * inverse, b = (p.half[k] - o[k]) * inverse;
    if (std::min(a, b) > enter) enter = std::min(a, b), axis = k;
    leave = std::min(leave, std::max(a, b));
  }
  if (enter <= 0 || enter > leave || enter >= nearest) return false;
  t = enter;
  normal.setZero();
  normal[axis] = d[axis] > 0 ? -1 : 1;
  pane = facade && axis < 2 && enter_opening(p, *facade, o, d, axis, t, normal);
  return true;
}

bool meet_cylinder(const Primitive& p, const Vector3f& o, const Vector3f& d, float& t,
                   Vector3f& normal) {
  const float r = p.half.x(), h = p.half.z();
  const float a = d.x() * d.x() + d.y() * d.y();
  // About the point nearest to the axis, so that a thin pole far away keeps its digits.
  const float middle = a > 0 ? -(o.x() * d.x() + o.y() * d.y()) / a : 0;
  const float mx = o.x() + middle * d.x(), my = o.y() + middle * d.y();
  const float inside = r * r - mx * mx - my * my;
  if (inside <= 0) return false;
  if (a > 0) {
    const float enter = middle - std::sqrt(inside / a);
    const float z = o.z() + enter * d.z();
    if (enter > 0 && std::abs(z) <= h) {
      t = enter;
      normal = {(o.x() + enter * d.x()) / r, (o.y() + enter * d.y()) / r, 0};
      return true;
    }
  }
  if (d.z() == 0) return false;
  const float lid = ((d.z() < 0 ? h : -h) - o.z()) / d.z();
  const float x = o.x() + lid * d.x(), y = o.y() + lid * d.y();
  if (lid <= 0 || x * x + y * y > r * r) return false;
  t = lid;
  normal = {0, 0, d.z() < 0 ? 1.0f : -1.0f};
  return true;
}

bool meet_ellipsoid(const Primitive& p, const Vector3f& o, const Vector3f& d, float& t,
                    Vector3f& normal) {
  const Vector3f so = o.cwiseQuotient(p.half), sd = d.cwiseQuotient(p.half);
  const float a = sd.squaredNorm();
  const float middle = -so.dot(sd) / a;
  const Vector3f m = so + middle * sd;
  const float inside = 1 - m.squaredNorm();
  if (inside <= 0) return false;
  t = middle - std::sqrt(inside / a);
  if (t <= 0) return false;
  normal = (o + t * d).cwiseQuotient(p.half.cwiseAbs2()).normalized();
  return true;
}

}  // namespace

Box bounds(const Primitive& p) {
  Vector3f reach = p.half;
  if (p.kind != Primitive::Kind::cylinder) {
    const float c = std::abs(p.cosine), s = std::abs(p.sine);
    reach.x() = c * p.half.x() + s * p.half.y();
    reach.y() = s * p.half.x() + c * p.half.y();
  }
  Box box;
  box.low = p.centre - reach;
  box.high = p.centre + reach;
  return box;
}

bool intersect(const Primitive& p, const Facade* facade, const Ray& ray, Hit& hit) {
  const Vector3f from = ray.origin - p.centre;
  const Vector3f& way = ray.direction;
  const float c = p.cosine, s = p.sine;
  const Vector3f o(c * from.x() + s * from.y(), c * from.y() - s * from.x(), from.z());
  const Vector3f d(c * way.x() + s * way.y(), c * way.y() - s * way.x(), way.z());
  float t = 0;
  Vector3f n;
  bool pane = false;
  bool met = false;
  switch (p.kind) {
    case Primitive::Kind::box:
      met = meet_box(p, facade, o, d, hit.t, t, n, pane);
      break;
    case Primitive::Kind::cylinder:
      met = meet_cylinder(p, o, d, t, n);
      break;
    case Primitive::Kind::ellipsoid:
      met = meet_ellipsoid(p, o, d, t, n);
      break;
  }
  if (!met || t >= hit.t) return false;
  hit = {t, Vector3f(c * n.x() - s * n.y(), s * n.x() + c * n.y(), n.z()),
         pane ? glass : p.reflectance};
  return true;
}

}  // namespace plumb::simulate
