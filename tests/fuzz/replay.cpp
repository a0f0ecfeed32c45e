/// fuzz_replay READER SEEDS FINDINGS: gives a reader every file of the two folders, without clang
/// and without sanitizers. The name of the input is told before it is read, so that the last one
/// told is the one that ended the process. Memory is bounded as when it is fuzzed.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "fuzz.hpp"

namespace plumb::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& from) {
  std::vector<fs::path> files;
  if (!fs::is_directory(from)) return files;
  for (const auto& entry : fs::directory_iterator(from)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

void bound_memory() {
  constexpr rlim_t most = rlim_t{512} << 20;
  const rlimit limit{most, most};
  require(setrlimit(RLIMIT_DATA, &limit) == 0, "memory can be bounded");
}

/// Gives the reader all files of a folder; how many it refused.
int refused(const Reader& reader, const fs::path& inputs) {
  int refused = 0;
  for (const fs::path& file : files_in(inputs)) {
    std::printf("%s\n", file.c_str());
    std::fflush(stdout);
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const std::string why = refusal(reader, bytes);
    if (!why.empty()) std::printf("  refused: %s\n", why.c_str());
    refused += !why.empty();
  }
  return refused;
}

/// A finding need only leave the process alive; a seed that is refused leads nowhere.
int replay(const Reader& reader, const fs::path& seeds, const fs::path& findings) {
  refused(reader, findings);
  if (files_in(seeds).empty()) std::printf("%s has no seeds in %s\n", reader.name, seeds.c_str());
  return files_in(seeds).empty() || refused(reader, seeds) > 0;
}

}  // namespace
}  // namespace plumb::fuzz

int main(int count, char** words) {
  using namespace plumb::fuzz;
  bound_memory();
  for (const Reader& reader : readers())
    if (count == 4 && reader.name == std::string_view(words[1]))
      return replay(reader, words[2], words[3]);
  std::fprintf(stderr, "usage: fuzz_replay READER SEEDS FINDINGS; the readers are:\n");
  for (const Reader& reader : readers()) std::fprintf(stderr, "  %s\n", reader.name);
  return 1;
}
