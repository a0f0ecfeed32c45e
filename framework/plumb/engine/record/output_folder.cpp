#include "plumb/engine/record/output_folder.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/data/file_name.hpp"
#include "plumb/engine/record/quoted.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void refuse(const fs::path& shown, const std::string& what, const std::string& move) {
  throw Error(shown.string() + ": " + what + "; give another folder with -o, or move " + move +
              " away");
}

/// Throws Error if it was the disk, or a permission, that kept a file from being looked at: then
/// nothing is known of it.
void require_looked_at(const fs::path& shown, const std::string& name) {
  for (const int why : {ENOENT, EINVAL, ELOOP, EFBIG, EBUSY})
    if (errno == why) return;
  refuse(shown, "'" + name + "' cannot be read (" + std::strerror(errno) + ")", "it");
}

/// What a run wrote in a folder, by its record; nothing when there is no record.
std::map<std::string, FileRecord> files_of_run(const io::Folder& folder, const fs::path& shown) {
  constexpr std::size_t longest = std::size_t{64} << 20;
  std::map<std::string, FileRecord> files;
  const auto text = folder.text(lock_name, longest);
  if (!text) return require_looked_at(shown, lock_name), files;
  const auto recorded = files_of_lock(*text);
  if (!recorded)
    refuse(shown,
           std::string("nothing tells what in it is a run's, for its ") + lock_name +
               " was changed since, or is of an earlier Plumb",
           "that folder");
  for (const FileRecord& file : *recorded) files[file.name] = file;
  files[lock_name] = {lock_name, text->size(), hash_of(*text)};
  return files;
}

/// Also a folder or a link under the name of a file is foreign.
void refuse_foreign(const io::Folder& folder, const fs::path& shown,
                    const std::vector<std::string>& names,
                    const std::map<std::string, FileRecord>& own) {
  std::vector<std::string> foreign;
  for (const std::string& name : names) {
    const bool is_file = folder.stamp(name).has_value();
    if (!is_file) require_looked_at(shown, name);
    if (!is_file || !own.contains(name)) foreign.push_back(name);
  }
  if (foreign.empty()) return;
  const std::size_t more = foreign.size() - 1;
  const std::string others = more > 0 ? " and " + counted(more, "more files") : "";
  refuse(shown, "holds '" + foreign.front() + "'" + others + " that no run of Plumb wrote",
         more > 0 ? "them" : "it");
}

/// All that is in a folder of results. Throws Error when not every bit of it is as a run wrote it.
io::Listing made_by_a_run(const io::Folder& folder, const fs::path& shown) {
  const auto names = folder.names();
  if (!names)
    refuse(shown, std::string("cannot be listed (") + std::strerror(errno) + ")", "that folder");
  if (names->empty()) return {};
  const auto files = files_of_run(folder, shown);
  refuse_foreign(folder, shown, *names, files);
  io::Listing listing;
  for (const std::string& name : *names) {
    const FileRecord& record = files.at(name);
    const auto stamp = folder.stamp(name);
    const bool same_size = stamp && stamp->size == record.bytes;
    const auto file = same_size ? folder.hashed(name) : std::nullopt;
    if (same_size && !file) require_looked_at(shown, name);
    if (!file || file->hash != record.hash)
      refuse(shown, "'" + name + "' was changed since a run wrote it", "it");
    listing.files.push_back({name, file->stamp});
  }
  return listing;
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder)
    : staged_(folder, "give another folder with -o", made_by_a_run) {}

std::string OutputFolder::fill(RunRecord record, const RunResult& result) {
  std::map<std::string, std::string> maker;  // by file name
  record.files.clear();
  for (const MadeDocument& made : result.documents) {
    const std::string& name = made.document->name;
    if (const std::string fault = fault_of_result_name(name); !fault.empty())
      throw Error("step '" + made.path + "': " + in_quotes(name) + " " + fault);
    const auto [at, is_new] = maker.try_emplace(name, made.path);
    if (!is_new)
      throw Error("steps '" + at->second + "' and '" + made.path + "' both write '" + name +
                  "'; give one another name");
    Hasher hasher;
    staged_.write(name, [&](const io::Take& take) {
      made.document->bytes.give([&](std::string_view piece) {
        hasher.bytes(piece.data(), piece.size());
        take(piece);
      });
    });
    record.files.push_back({name, made.document->bytes.size(), hasher.hash()});
  }
  staged_.write(lock_name, [&](const io::Take& take) { take(lock_text(record)); });
  try {
    staged_.look_again();  // the folder may have changed meanwhile
  } catch (const Error& e) {
    throw Error(std::string(e.what()) + "; what this run made is in " + staged_.keep().string());
  }
  return staged_.finish();
}

std::string fault_of_result_name(const std::string& name) {
  return name == lock_name ? "is what the run itself writes; choose another name"
                           : fault_of_file_name(name);
}

}  // namespace plumb
