#include "plumb/engine/output_folder.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "plumb/data/error.hpp"
#include "plumb/data/io/regular_file.hpp"
#include "plumb/engine/quoted.hpp"
#include "plumb/pipeline/foreign_file.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

constexpr const char* first_line = pipeline::lock_first_line;

/// The files that the run in `folder` wrote, by its lock; empty when there is none.
std::set<std::string> files_of_run(const fs::path& folder) {
  if (!io::other_than_file(folder / lock_name).empty()) return {};
  std::ifstream in(folder / lock_name);
  std::string line;
  std::set<std::string> files;
  if (!std::getline(in, line) || line != first_line) return files;
  files.insert(lock_name);
  bool in_list = false;
  while (std::getline(in, line)) {
    if (line == "files:") in_list = true;
    else if (in_list && line.starts_with("  - ")) files.insert(from_quotes(line.substr(4)).value_or(line.substr(4)));
    else in_list = false;
  }
  return files;
}

std::string plural(std::size_t n) { return n == 1 ? "" : "s"; }

void refuse_foreign_files(const fs::path& folder) {
  const auto own = files_of_run(folder);
  std::vector<std::string> foreign;
  for (const auto& entry : fs::directory_iterator(folder))
    if (!own.contains(entry.path().filename().string())) foreign.push_back(entry.path().filename().string());
  if (foreign.empty()) return;
  throw Error(folder.string() + ": holds '" + foreign.front() + "'" +
              (foreign.size() > 1 ? " and " + std::to_string(foreign.size() - 1) + " more file" + plural(foreign.size() - 1) : "") +
              " that no run of Plumb wrote; give another folder with -o, or move them away");
}

void write_file(const fs::path& file, const FileBytes& bytes) {
  std::ofstream out(file, std::ios::binary);
  bytes.give([&](std::string_view piece) { out.write(piece.data(), static_cast<std::streamsize>(piece.size())); });
  out.close();
  if (!out) throw Error(file.string() + ": cannot be written; is the disk full?");
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder) : staged_(folder, "give another folder with -o") {
  if (fs::exists(staged_.place())) refuse_foreign_files(staged_.place());
}

void OutputFolder::fill(RunRecord record, const RunResult& result) {
  std::map<std::string, std::string> maker;  // by file name
  record.files.clear();
  for (const MadeDocument& made : result.documents) {
    const std::string& name = made.document->name;
    if (const std::string fault = fault_of_file_name(name); !fault.empty())
      throw Error("step '" + made.path + "': '" + name + "' " + fault);
    const auto [at, is_new] = maker.try_emplace(name, made.path);
    if (!is_new)
      throw Error("steps '" + at->second + "' and '" + made.path + "' both write '" + name + "'; give one another name");
    write_file(staged_.staging() / name, made.document->bytes);
    record.files.push_back(name);
  }
  write_file(staged_.staging() / lock_name, lock_text(record));
  try {
    if (fs::exists(staged_.place())) refuse_foreign_files(staged_.place());  // it may have changed meanwhile
  } catch (const Error& e) {
    throw Error(std::string(e.what()) + "; what this run made is in " + staged_.keep().string());
  }
  staged_.finish();
}

std::string fault_of_file_name(const std::string& name) {
  const bool plain = std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (name == lock_name) return "is what the run itself writes; choose another name";
  if (name.empty() || name == "." || name == ".." || name != fs::path(name).filename() || name.size() > 200 || !plain)
    return "is no name for a file in the output folder (no slashes, no control characters, 200 bytes at most); choose another";
  return "";
}

}  // namespace plumb
