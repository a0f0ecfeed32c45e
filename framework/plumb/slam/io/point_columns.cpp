#include "plumb/slam/io/point_columns.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>

#include "plumb/data/counted.hpp"
#include "plumb/data/short_number.hpp"

namespace plumb::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the readers copy little-endian numbers");

/// Which column feeds which array of a cloud; null where the file has none.
struct Roles {
  const Column *x, *y, *z, *intensity, *time, *ring, *nx, *ny, *nz;
};

const Column* find(const std::vector<Column>& columns,
                   std::initializer_list<std::string_view> names) {
  for (const auto name : names)
    for (const auto& column : columns)
      if (column.name == name) return &column;
  return nullptr;
}

Roles roles_of(const std::filesystem::path& file, const std::vector<Column>& columns) {
  Roles roles{find(columns, {"x"}),
              find(columns, {"y"}),
              find(columns, {"z"}),
              find(columns, {"intensity", "scalar_Intensity", "scalar_intensity"}),
              find(columns, {"time", "t"}),
              find(columns, {"ring"}),
              find(columns, {"normal_x", "nx"}),
              find(columns, {"normal_y", "ny"}),
              find(columns, {"normal_z", "nz"})};
  for (const auto& [role, name] : {std::pair{roles.x, "x"}, {roles.y, "y"}, {roles.z, "z"}}) {
    if (!role) refuse(file, std::string("has no field '") + name + "': a cloud needs x, y and z");
    if (!is_float(role->number))
      refuse(file, std::string("has a field '") + name +
                       "' of integers: a cloud needs x, y and z as floating-point metres");
  }
  if (!roles.nx || !roles.ny || !roles.nz) roles.nx = roles.ny = roles.nz = nullptr;
  return roles;
}

double time_unit(const Column& column) { return is_float(column.number) ? 1.0 : 1e-9; }

template <class From, class To>
void copy(const char* from, std::size_t stride, std::vector<To>& to) {
  for (auto& value : to) {
    From number;
    std::memcpy(&number, from, sizeof number);
    value = static_cast<To>(number);
    from += stride;
  }
}

template <class To>
void fill(const Column& column, std::string_view data, std::size_t points, std::vector<To>& to) {
  to.resize(points);
  const char* from = data.data() + column.offset;
  switch (column.number) {
    case Number::i8:
      return copy<std::int8_t>(from, column.stride, to);
    case Number::u8:
      return copy<std::uint8_t>(from, column.stride, to);
    case Number::i16:
      return copy<std::int16_t>(from, column.stride, to);
    case Number::u16:
      return copy<std::uint16_t>(from, column.stride, to);
    case Number::i32:
      return copy<std::int32_t>(from, column.stride, to);
    case Number::u32:
      return copy<std::uint32_t>(from, column.stride, to);
    case Number::i64:
      return copy<std::int64_t>(from, column.stride, to);
    case Number::u64:
      return copy<std::uint64_t>(from, column.stride, to);
    case Number::f32:
      return copy<float>(from, column.stride, to);
    case Number::f64:
      return copy<double>(from, column.stride, to);
  }
}

/// A ring as the cloud keeps it.
std::uint16_t ring_of(const std::filesystem::path& file, double value) {
  if (!(value >= 0 && value <= std::numeric_limits<std::uint16_t>::max()))
    refuse(file, "has the ring " + short_number(value) + ": a ring is a number from 0 to 65535");
  return static_cast<std::uint16_t>(value);
}

template <class T>
void keep(const std::vector<std::uint32_t>& kept, std::vector<T>& values) {
  if (values.empty()) return;
  for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
  values.resize(kept.size());
}

/// Drops the points that are nowhere.
CloudFile finite_only(Cloud&& cloud) {
  CloudFile result{std::move(cloud), 0};
  Cloud& c = result.cloud;
  const auto finite = [&](std::size_t k) {
    return std::isfinite(c.x[k]) && std::isfinite(c.y[k]) && std::isfinite(c.z[k]);
  };
  for (std::size_t k = 0; k < c.size(); ++k) result.dropped += !finite(k);
  if (result.dropped == 0) return result;
  std::vector<std::uint32_t> kept;
  kept.reserve(c.size() - result.dropped);
  for (std::size_t k = 0; k < c.size(); ++k)
    if (finite(k)) kept.push_back(static_cast<std::uint32_t>(k));
  for (auto* values : {&c.x, &c.y, &c.z, &c.intensity, &c.time, &c.nx, &c.ny, &c.nz})
    keep(kept, *values);
  keep(kept, c.ring);
  return result;
}

}  // namespace

std::size_t size_of(Number number) {
  switch (number) {
    case Number::i8:
    case Number::u8:
      return 1;
    case Number::i16:
    case Number::u16:
      return 2;
    case Number::i32:
    case Number::u32:
    case Number::f32:
      return 4;
    default:
      return 8;
  }
}

bool is_float(Number number) { return number == Number::f32 || number == Number::f64; }

CloudFile from_bytes(const std::filesystem::path& file, const std::vector<Column>& columns,
                     std::string_view data, std::size_t points) {
  const Roles roles = roles_of(file, columns);
  Cloud cloud;
  fill(*roles.x, data, points, cloud.x);
  fill(*roles.y, data, points, cloud.y);
  fill(*roles.z, data, points, cloud.z);
  if (roles.intensity) fill(*roles.intensity, data, points, cloud.intensity);
  if (roles.time) {
    fill(*roles.time, data, points, cloud.time);
    const double unit = time_unit(*roles.time);
    if (unit != 1.0)
      for (auto& t : cloud.time) t = static_cast<float>(t * unit);
  }
  if (roles.ring && roles.ring->number == Number::u16) {
    fill(*roles.ring, data, points, cloud.ring);
  } else if (roles.ring) {
    std::vector<double> rings;
    fill(*roles.ring, data, points, rings);
    cloud.ring.reserve(points);
    for (const double ring : rings) cloud.ring.push_back(ring_of(file, ring));
  }
  if (roles.nx) {
    fill(*roles.nx, data, points, cloud.nx);
    fill(*roles.ny, data, points, cloud.ny);
    fill(*roles.nz, data, points, cloud.nz);
  }
  return finite_only(std::move(cloud));
}

CloudFile from_text(const std::filesystem::path& file, const std::vector<Column>& columns,
                    Lines& lines, std::size_t words, std::size_t points) {
  const Roles roles = roles_of(file, columns);
  if (points == 0) return {};  // then nothing says that the file can hold so many words
  Cloud cloud;
  cloud.reserve(points);
  std::vector<double> numbers(words);
  std::string_view line;
  for (std::size_t have = 0; have < points;) {
    if (!lines.next(line))
      refuse(file, "holds " + counted(have, "points") + " where its header promises " +
                       std::to_string(points) + ": the file is cut short, write it again");
    std::size_t count = 0;
    for (auto word = next_word(line); !word.empty(); word = next_word(line), ++count) {
      if (count < words && !to_number(word, numbers[count]))
        refuse(file, lines.number(),
               in_quotes(word) + " is not a number: correct it or leave the line out");
    }
    if (count == 0) continue;
    if (count != words)
      refuse(file, lines.number(),
             "has " + counted(count, "numbers") + " where the header names " +
                 std::to_string(words) + ": correct the line or the header");
    const auto value = [&](const Column* c) { return static_cast<float>(numbers[c->offset]); };
    cloud.x.push_back(value(roles.x));
    cloud.y.push_back(value(roles.y));
    cloud.z.push_back(value(roles.z));
    if (roles.intensity) cloud.intensity.push_back(value(roles.intensity));
    if (roles.time)
      cloud.time.push_back(
          static_cast<float>(numbers[roles.time->offset] * time_unit(*roles.time)));
    if (roles.ring) cloud.ring.push_back(ring_of(file, numbers[roles.ring->offset]));
    if (roles.nx) {
      cloud.nx.push_back(value(roles.nx));
      cloud.ny.push_back(value(roles.ny));
      cloud.nz.push_back(value(roles.nz));
    }
    ++have;
  }
  return finite_only(std::move(cloud));
}

void require_room(const std::filesystem::path& file, std::uint64_t points, std::uint64_t least,
                  std::size_t available) {
  if (points > std::numeric_limits<std::uint32_t>::max() ||
      (least > 0 && points > available / least))
    refuse(file, "its header promises " + counted(points, "points") + " of " +
                     counted(least, "bytes") + " or more, but only " + std::to_string(available) +
                     " bytes follow: the file is cut short or its header is wrong, write it again");
}

}  // namespace plumb::io
