#include "plumb/engine/output_folder.hpp"

#include <unistd.h>

#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "plumb/data/error.hpp"
#include "plumb/pipeline/foreign_file.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

constexpr const char* first_line = pipeline::lock_first_line;

/// The files that the run in `folder` wrote, by its lock; empty when there is none.
std::set<std::string> files_of_run(const fs::path& folder) {
  std::ifstream in(folder / lock_name);
  std::string line;
  std::set<std::string> files;
  if (!std::getline(in, line) || line != first_line) return files;
  files.insert(lock_name);
  bool in_list = false;
  while (std::getline(in, line)) {
    if (line == "files:") in_list = true;
    else if (in_list && line.starts_with("  - ")) files.insert(line.substr(4));
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

void write_file(const fs::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw Error(file.string() + ": cannot be written; is the disk full?");
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder) : folder_(fs::absolute(folder).lexically_normal()) {
  if (folder_.filename().empty()) folder_ = folder_.parent_path();
  std::error_code error;
  if (fs::exists(folder_, error)) {
    if (!fs::is_directory(folder_)) throw Error(folder_.string() + ": is a file, not a folder; give another with -o");
    refuse_foreign_files(folder_);
  }
  fs::create_directories(folder_.parent_path(), error);
  const fs::path partial = folder_.string() + ".partial-" + std::to_string(getpid());
  if (!error) fs::create_directory(partial, error);
  if (error) throw Error(folder_.string() + ": cannot be written (" + error.message() + "); give another folder with -o");
  partial_ = partial;
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!partial_.empty()) fs::remove_all(partial_, ignored);
}

void OutputFolder::fill(const Plan& plan, const RunResult& result) {
  std::map<std::string, std::string> maker;  // by file name
  std::vector<std::string> files;
  for (const MadeDocument& made : result.documents) {
    const std::string& name = made.document->name;
    if (name.empty() || name == lock_name || name != fs::path(name).filename())
      throw Error("step '" + made.path + "': '" + name + "' is no name for a file in the output folder; choose another");
    const auto [at, is_new] = maker.try_emplace(name, made.path);
    if (!is_new)
      throw Error("steps '" + at->second + "' and '" + made.path + "' both write '" + name + "'; give one another name");
    write_file(partial_ / name, made.document->bytes);
    files.push_back(name);
  }
  write_file(partial_ / lock_name, lock_text(plan, files));
  if (fs::exists(folder_)) {
    refuse_foreign_files(folder_);  // it may have changed meanwhile
    const fs::path old = folder_.string() + ".old-" + std::to_string(getpid());
    fs::rename(folder_, old);
    fs::rename(partial_, folder_);
    fs::remove_all(old);
  } else {
    fs::rename(partial_, folder_);
  }
  partial_.clear();
}

std::string lock_text(const Plan& plan, const std::vector<std::string>& files) {
  std::ostringstream out;
  out << first_line << "\nplumb: " << PLUMB_VERSION << "\nfiles:\n";
  for (const auto& file : files) out << "  - " << file << '\n';
  out << "steps:\n";
  for (const PlannedStep& step : plan.steps)
    out << "  " << step.path << ": " << step.description->name << " version " << step.description->version << '\n';
  out << "pipeline: |\n";
  std::istringstream lines(plan.resolved);
  for (std::string line; std::getline(lines, line);) out << "  " << line << '\n';
  return out.str();
}

}  // namespace plumb
