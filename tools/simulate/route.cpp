#include "simulate/route.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "simulate/names.hpp"
#include "simulate/random.hpp"

namespace plumb::simulate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Line = std::vector<Vector2d>;

constexpr double shortest_block = 40;  // [m], else houses find no room between the streets
constexpr double lane = 1.75;          // from the middle of the street [m]
constexpr double corner_radius = 7;    // [m]
constexpr double again = 1.2;          // rounds of a loop

/// The crossings passed on a walk over a 3 x 3 grid; it ends where it begins, from another side,
/// and never turns on the spot.
constexpr std::array<std::array<int, 2>, 34> walk{
    {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 0}, {0, 0}, {0, 1},
     {0, 2}, {1, 2}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2},
     {0, 2}, {0, 1}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {2, 0}, {1, 0}, {1, 1}, {0, 1}}};

double length_of(const Line& line) {
  double sum = 0;
  for (std::size_t k = 1; k < line.size(); ++k) sum += (line[k] - line[k - 1]).norm();
  return sum;
}

/// The line moved to the right by `offset` [m]; where it bends, to the meeting point of its
/// neighbours.
Line moved_right(const Line& line, double offset) {
  Line result;
  const auto right = [&](std::size_t k) {  // of the piece from k to k + 1
    const Vector2d way = (line[k + 1] - line[k]).normalized();
    return Vector2d(way.y(), -way.x());
  };
  for (std::size_t k = 0; k < line.size(); ++k) {
    const Vector2d a = right(k == 0 ? 0 : k - 1), b = right(std::min(k, line.size() - 2));
    result.push_back(line[k] + offset / std::max(0.3, 1 + a.dot(b)) * (a + b));
  }
  return result;
}

/// The line with arcs for corners, as points some 0.1 m apart on the arcs.
Line rounded(const Line& line) {
  Line result{line.front()};
  for (std::size_t k = 1; k + 1 < line.size(); ++k) {
    const Vector2d in = line[k] - line[k - 1], out = line[k + 1] - line[k];
    const Vector2d a = in.normalized(), b = out.normalized();
    const double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    const double half_tangent = std::tan(0.5 * std::abs(turn));
    if (half_tangent < 1e-3) continue;
    const double room = 0.45 * std::min(in.norm(), out.norm());
    const double radius =
        std::min(std::abs(turn) < 0.6 ? 4 * corner_radius : corner_radius, room / half_tangent);
    const Vector2d begin = line[k] - radius * half_tangent * a;
    const Vector2d centre = begin + std::copysign(radius, turn) * Vector2d(-a.y(), a.x());
    const int pieces = std::max(2, static_cast<int>(radius * std::abs(turn) / 0.1));
    for (int n = 0; n <= pieces; ++n) {
      const double angle = turn * n / pieces;
      const Vector2d arm = begin - centre;
      result.push_back(centre + Vector2d(std::cos(angle) * arm.x() - std::sin(angle) * arm.y(),
                                         std::sin(angle) * arm.x() + std::cos(angle) * arm.y()));
    }
  }
  result.push_back(line.back());
  return result;
}

/// The crossings of a loop, displaced at random once and passed on each round alike, for two
/// rounds.
Line two_rounds(const Line& loop, double bend, Random& random) {
  Line bent;
  for (const Vector2d& p : loop)
    bent.push_back(p + bend * Vector2d(random.uniform(-1, 1), random.uniform(-1, 1)));
  Line result = bent;
  result.insert(result.end(), bent.begin(), bent.end());
  result.push_back(bent.front());
  return result;
}

Line city_loop(double length, Random& random) {
  const double block = std::max(shortest_block, length / again / 6);
  Line loop;
  for (const auto& [x, y] : {std::array{0.5, 0.0},
                             {2.0, 0.0},
                             {2.0, 0.5},
                             {2.0, 1.0},
                             {1.0, 1.0},
                             {0.0, 1.0},
                             {0.0, 0.5},
                             {0.0, 0.0}})
    loop.emplace_back(block * x, block * y);
  return two_rounds(loop, 0.07 * block, random);
}

Line figure_eight(double length, Random& random) {
  const double block = std::max(shortest_block, length / again / 8);
  Line loop;
  for (const auto& [x, y] : {std::array{0.5, 0.0},
                             {1.0, 0.0},
                             {1.0, 1.0},
                             {0.0, 1.0},
                             {0.0, 0.5},
                             {0.0, -0.5},
                             {0.0, -1.0},
                             {-1.0, -1.0},
                             {-1.0, 0.0},
                             {-0.5, 0.0}})
    loop.emplace_back(block * x, block * y);
  return two_rounds(loop, 0.05 * block, random);
}

Line out_and_back(double length, Random& random) {
  constexpr double round_the_end = 62;  // [m]
  const double out = std::max(0.5 * (length - round_the_end), 20.0);
  Line way{{0, 0}};
  double heading = random.uniform(-0.2, 0.2);
  const int pieces = std::max(1, static_cast<int>(out / 90));
  for (int k = 0; k < pieces; ++k) {
    way.push_back(way.back() + out / pieces * Vector2d(std::cos(heading), std::sin(heading)));
    heading = std::clamp(heading + random.uniform(-0.7, 0.7), -1.0, 1.0);
  }
  const std::size_t corners = way.size();
  const Vector2d ahead = (way[corners - 1] - way[corners - 2]).normalized(),
                 left(-ahead.y(), ahead.x());
  const Vector2d end = way.back();
  for (const auto& [x, y] : {std::array{8.0, -8.0}, {22.0, -8.0}, {22.0, 8.0}, {8.0, 8.0}})
    way.push_back(end + x * ahead + y * left);
  for (std::size_t k = corners; k-- > 0;) way.push_back(way[k]);
  way.push_back(way.back() + 50 * (way.back() - way[way.size() - 2]).normalized());
  return way;
}

Line blocks(double length, Random& random) {
  const double block = std::max(shortest_block, length / static_cast<double>(walk.size()));
  std::array<std::array<Vector2d, 3>, 3> crossing;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      crossing[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
          block * Vector2d(i + random.uniform(-0.09, 0.09), j + random.uniform(-0.09, 0.09));
  Line way;
  for (int round = 0; round < 2; ++round)
    for (const auto& [i, j] : walk)
      way.push_back(crossing[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
  return way;
}

/// Height of the land [m]: a few long waves.
struct Hills {
  std::array<double, 12> phase;
  explicit Hills(Random& random) {
    for (double& p : phase) p = random.uniform(0, 2 * std::numbers::pi);
  }
  double at(const Vector2d& p) const {
    double sum = 0;
    for (std::size_t k = 0; k < 6; ++k) {
      const double direction = phase[6 + k], wave = 90 + 45 * static_cast<double>(k);
      const double along = std::cos(direction) * p.x() + std::sin(direction) * p.y();
      sum += 0.004 * wave * std::sin(2 * std::numbers::pi * along / wave + phase[k]);
    }
    return sum;
  }
};

}  // namespace

const std::vector<std::string>& route_names() {
  static const std::vector<std::string> names{"city_loop", "figure_eight", "out_and_back",
                                              "blocks"};
  return names;
}

Trajectory drive(const RouteOptions& options) {
  Random random(mix(options.seed, 0x726f757465));
  Line middle;
  if (options.name == "city_loop")
    middle = city_loop(options.length, random);
  else if (options.name == "figure_eight")
    middle = figure_eight(options.length, random);
  else if (options.name == "out_and_back")
    middle = out_and_back(options.length, random);
  else if (options.name == "blocks")
    middle = blocks(options.length, random);
  else
    throw Error("no route is called '" + options.name + "'; " +
                suggestion(options.name, route_names()));
  const Line line = rounded(moved_right(middle, lane));
  const Hills hills(random);
  const double rocking = random.uniform(0, 6);

  // Corners cut short make some lines a little shorter than asked: those are stretched.
  const double line_length = length_of(line);
  const double stretch = std::max(1.0, (options.length + 1) / line_length);
  std::vector<double> reached{0};
  for (std::size_t k = 1; k < line.size(); ++k)
    reached.push_back(reached.back() + stretch * (line[k] - line[k - 1]).norm());
  const auto at = [&](double s) {
    const auto next = std::upper_bound(reached.begin() + 1, reached.end() - 1, s);
    const auto k = static_cast<std::size_t>(next - reached.begin());
    const double share = (s - reached[k - 1]) / (reached[k] - reached[k - 1]);
    return Vector2d(stretch * (line[k - 1] + share * (line[k] - line[k - 1])));
  };

  Trajectory result;
  const auto last = static_cast<double>(options.frames - 1);
  for (std::size_t k = 0; k < options.frames; ++k) {
    const double s = options.length * static_cast<double>(k) / last;
    const double time = static_cast<double>(k) / options.rate;
    const Vector2d here = at(s), way = (at(s + 0.8) - at(std::max(0.0, s - 0.8))).normalized();
    const Vector2d left(-way.y(), way.x());
    const double climb = hills.at(here + way) - hills.at(here - way);  // over 2 m
    const double bank = hills.at(here + left) - hills.at(here - left);
    const double pitch = -std::atan2(climb, 2.0) + 0.004 * std::sin(0.9 * time + rocking);
    const double roll = std::atan2(bank, 2.0) + 0.004 * std::sin(1.3 * time + 2 * rocking);
    const Eigen::Quaterniond q =
        Eigen::AngleAxisd(std::atan2(way.y(), way.x()), Vector3d::UnitZ()) *
        Eigen::AngleAxisd(pitch, Vector3d::UnitY()) * Eigen::AngleAxisd(roll, Vector3d::UnitX());
    result.stamps.push_back(time);
    result.T_world_frame.emplace_back(
        q, Vector3d(here.x(), here.y(), hills.at(here) + options.sensor_height));
  }
  return result;
}

}  // namespace plumb::simulate
