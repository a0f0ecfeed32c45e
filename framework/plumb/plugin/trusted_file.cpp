#include "plumb/plugin/trusted_file.hpp"

#include <dlfcn.h>
#include <sys/stat.h>

#include <algorithm>

#include "plumb/data/io/ownership.hpp"
#include "plumb/data/io/regular_file.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

bool lies_in(const fs::path& file, const fs::path& folder) {
  return std::ranges::mismatch(folder, file).in1 == folder.end();
}

/// The first thing that is wrong with a path without links, from itself up to the root.
std::string fault_above(const fs::path& real, const fs::path& given) {
  static const fs::path library = this_library();
  struct stat info {};
  const std::optional<unsigned> owner =
      stat(library.c_str(), &info) == 0 ? std::optional<unsigned>(info.st_uid) : std::nullopt;
  for (fs::path at = real;; at = at.parent_path()) {
    const auto judging = at == real             ? io::Judging::entry
                         : lies_in(library, at) ? io::Judging::lenient
                                                : io::Judging::above;
    if (const auto loose = io::looseness_of(at, judging, owner))
      return (at == given ? "" : at.string() + " ") + loose->what +
             ", so that others could put code there; " + loose->cure();
    if (at == at.root_path()) return "";
  }
}

}  // namespace

fs::path this_library() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&abi_tag), &info) && info.dli_fname)
    return fs::weakly_canonical(info.dli_fname);
  return {};
}

fs::path folder_of_this_library() { return this_library().parent_path(); }

std::string fault_of_folder(const fs::path& folder) {
  std::error_code error;
  const fs::path real = fs::canonical(folder, error);
  if (error) return "there is no such folder";
  return fs::is_directory(real) ? fault_above(real, folder) : "is not a directory";
}

std::string fault_of_file(const fs::path& file) {
  std::error_code error;
  const fs::path real = fs::canonical(file, error);
  if (error) return "cannot be found (" + error.message() + ")";
  if (const std::string other = io::other_than_file(real); !other.empty())
    return "is " + other + ", not a regular file";
  return fault_above(real, file);
}

}  // namespace plumb
