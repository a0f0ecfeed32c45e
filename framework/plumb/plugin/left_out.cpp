#include "plumb/plugin/left_out.hpp"

#include "plumb/data/error.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/plugin/trusted_file.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t largest_file = std::uint64_t{1} << 20;  // [byte]

}  // namespace

StepsLeftOut read_left_out(std::string_view text, const fs::path& file) {
  constexpr std::string_view between = ": ";
  StepsLeftOut steps;
  io::Lines lines(text);
  for (std::string_view line; lines.next(line);) {
    const std::size_t at = line.find(between);
    if (at == 0 || at == line.npos || at + between.size() == line.size())
      io::refuse(file, lines.number(),
                 "expected 'STEP: WHY', found " + io::in_quotes(line) + "; build again");
    steps.emplace(line.substr(0, at), line.substr(at + between.size()));
  }
  return steps;
}

StepsLeftOut left_out_beside(const fs::path& modules) {
  const fs::path file = modules / "left_out.txt";
  if (std::error_code error; !fs::exists(file, error)) return {};
  if (const std::string fault = fault_of_file(file); !fault.empty())
    throw Error(file.string() + " " + fault);
  return read_left_out(io::FileBytes(file, largest_file, "list of steps").view(), file);
}

}  // namespace plumb
