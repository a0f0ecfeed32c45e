#pragma once
/// From a file's columns of numbers to a cloud: what PCD and PLY have in common.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/data/io/file_text.hpp"
#include "plumb/slam/io/cloud_file.hpp"

namespace plumb::io {

/// How one number is stored.
enum class Number { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

std::size_t size_of(Number number);
bool is_float(Number number);

/// A named number of each point, and where the first point's lies.
struct Column {
  std::string name;
  Number number = Number::f32;
  std::size_t offset =
      0;  ///< [byte] from the start of the data; for text: index of the word in the line
  std::size_t stride = 0;  ///< [byte] from point to point; for text unused
};

/// The cloud in `data`, in which every column holds `points` numbers (checked by the caller). Known
/// columns: x y z; intensity; time or t ([s]; an integer is [ns]); ring; normal_x normal_y normal_z
/// or nx ny nz. Others are skipped. Points with a non-finite coordinate are dropped
/// and counted. Throws Error: no x y z, a ring that is no 16-bit number.
CloudFile from_bytes(const std::filesystem::path& file, const std::vector<Column>& columns,
                     std::string_view data, std::size_t points);

/// The same from text, which has room for them (require_room), one point a line of `words` numbers;
/// blank lines are skipped. Throws Error with the line: fewer or more words than that, no number,
/// fewer lines than points. Leaves `lines` behind the last point.
CloudFile from_text(const std::filesystem::path& file, const std::vector<Column>& columns,
                    Lines& lines, std::size_t words, std::size_t points);

/// Throws Error unless `points` of `least` bytes each fit into `available` bytes: asked before
/// anything is allocated.
void require_room(const std::filesystem::path& file, std::uint64_t points, std::uint64_t least,
                  std::size_t available);

}  // namespace plumb::io
