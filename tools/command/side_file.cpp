#include "side_file.hpp"

#include <algorithm>
#include <fstream>

#include "plumb/data/error.hpp"
#include "plumb/engine/record/run_record.hpp"

namespace plumb::command {
namespace fs = std::filesystem;

namespace {

/// What a path leads to; of one that leads nowhere or to no file (/dev/fd/63) itself.
fs::path place_of(const fs::path& path) {
  std::error_code error;
  auto place = fs::weakly_canonical(path, error);
  return error ? fs::absolute(path).lexically_normal() : place;
}

bool within(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

/// Whether a folder could be made or used by who marks his with the file `mark`, as far as one look
/// tells.
bool may_be_of(const fs::path& folder, const char* mark) {
  std::error_code error;
  if (folder == folder.root_path()) return false;
  if (!fs::exists(folder, error)) return true;
  return fs::is_directory(folder, error) &&
         (fs::is_empty(folder, error) || fs::exists(folder / mark, error));
}

bool may_hold_results(const fs::path& output) { return may_be_of(place_of(output), lock_name); }

[[noreturn]] void refuse_output(const fs::path& output, const std::string& inside) {
  throw Error("-o " + output.string() +
              ": the results get a folder of their own, and this one holds " + inside +
              "; give another folder");
}

/// The first bytes of a file.
std::string begin_of(const fs::path& file, std::size_t size) {
  std::string bytes(size, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

}  // namespace

void require_elsewhere(const std::vector<SideFile>& files, const fs::path& output) {
  const auto folder = place_of(output);
  for (std::size_t k = 0; k < files.size(); ++k) {
    if (files[k].file.empty()) continue;
    const auto file = place_of(files[k].file);
    const std::string place = files[k].option + " " + files[k].file.string() + ": ";
    if (within(file, folder) && !may_hold_results(output))
      refuse_output(output, "the file of " + files[k].option);
    if (within(file, folder))
      throw Error(place +
                  "lies in the folder for the results, which holds what steps wrote alone; name a "
                  "file beside it");
    for (std::size_t n = 0; n < k; ++n)
      if (!files[n].file.empty() && place_of(files[n].file) == file)
        throw Error(place + "is what " + files[n].option + " writes too; name another file");
  }
}

void require_apart(const StoreOption& store, const fs::path& output) {
  if (store.folder().empty()) return;
  const auto results = place_of(store.folder()), folder = place_of(output);
  if (within(results, folder)) {
    if (!store.by_option() || !may_hold_results(output)) refuse_output(output, store.title());
    throw Error(store.title() +
                ": lies in the folder for the results, which holds what steps wrote alone; name a "
                "folder beside it");
  }
  if (!within(folder, results)) return;
  const bool is_cache = may_be_of(results, store_mark);
  throw Error((is_cache ? "-o " + output.string() + ": lies in " + store.title()
                        : store.title() + ": -o " + output.string() + " lies in it") +
              ", and a cache holds its own files alone; give another folder");
}

void begin(const SideFile& side) {
  const std::string place = side.option + " " + side.file.string() + ": ";
  std::error_code error;
  const auto status = fs::status(side.file, error);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status))
    return;  // a pipe or a device: nothing stands in it that could be lost
  if (fs::is_directory(status) || (fs::is_regular_file(status) && fs::file_size(side.file) > 0 &&
                                   begin_of(side.file, side.mark.size()) != side.mark))
    throw Error(place + "exists and is no " + side.what + " of plumb; name another file");
  std::ofstream out(side.file);
  out.close();
  if (!out) throw Error(place + "cannot be written; name a file in a folder that exists");
}

}  // namespace plumb::command
