#include "fuzz.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace plumb::fuzz {
namespace fs = std::filesystem;
namespace {

struct OwnFolder {
  fs::path path;
  OwnFolder() {
    std::string name = (fs::temp_directory_path() / "plumb_fuzz_XXXXXX").string();
    require(::mkdtemp(name.data()) != nullptr, "a folder for the inputs can be made");
    path = name;
  }
  ~OwnFolder() {
    std::error_code error;
    fs::remove_all(path, error);
  }
};

}  // namespace

std::vector<Reader>& readers() {
  static std::vector<Reader> all;
  return all;
}

std::string refusal(const Reader& reader, std::string_view bytes) {
  try {
    reader.read(bytes);
    return "";
  } catch (const Error& error) {
    require(*error.what() != '\0', "what is refused is refused in words");
    return error.what();
  }
}

const fs::path& folder() {
  static const OwnFolder own;
  return own.path;
}

fs::path file_of(std::string_view bytes, const std::string& name) {
  const fs::path file = folder() / name;
  const int to = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  require(to >= 0 &&
              ::write(to, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()) &&
              ::close(to) == 0,
          "inputs can be written");
  return file;
}

std::vector<std::string_view> parts_of(std::string_view bytes, std::size_t parts) {
  constexpr std::string_view cut = "---8<---\n";
  std::vector<std::string_view> found;
  while (found.size() + 1 < parts) {
    const auto at = bytes.find(cut);
    found.push_back(bytes.substr(0, at));
    bytes.remove_prefix(at == bytes.npos ? bytes.size() : at + cut.size());
  }
  found.push_back(bytes);
  return found;
}

void require(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "BROKEN PROMISE: %s\n", promise);
  std::abort();
}

}  // namespace plumb::fuzz
