#pragma once
/// What the fuzz drivers share. A driver is one reader and what is done with the bytes it is given:
///
///     PLUMB_FUZZ_READER(tum) { read_tum(file_of(bytes)); }
///
/// Error is the reader's right; all else that it ends in is a finding: another exception, a crash,
/// a sanitizer's report, a promise that does not hold, more than a second or 512 MiB.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/data/error.hpp"

namespace plumb::fuzz {

struct Reader {
  const char* name;
  void (*read)(std::string_view bytes);
};

/// All that are linked into this program.
std::vector<Reader>& readers();

/// Gives bytes to a reader. What it says when it does not take them; empty when it does.
std::string refusal(const Reader& reader, std::string_view bytes);

/// This process's own folder, removed at its end.
const std::filesystem::path& folder();

/// A file of these bytes in that folder, in the place of what was there before.
std::filesystem::path file_of(std::string_view bytes, const std::string& name = "input");

/// Bytes that stand for several texts, cut at lines "---8<---"; what is missing is empty.
std::vector<std::string_view> parts_of(std::string_view bytes, std::size_t parts);

/// Ends the process when a promise of the reader's page or header does not hold.
void require(bool holds, const char* promise);

}  // namespace plumb::fuzz

#define PLUMB_FUZZ_READER(reader)                                         \
  static void fuzz_##reader(std::string_view bytes);                      \
  [[maybe_unused]] static const bool reader##_is_known =                  \
      (plumb::fuzz::readers().push_back({#reader, fuzz_##reader}), true); \
  static void fuzz_##reader(std::string_view bytes)
