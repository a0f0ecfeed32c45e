#include "plumb/engine/record/input_record.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>

#include "plumb/data/error.hpp"
#include "plumb/data/io/file_identity.hpp"
#include "plumb/data/io/staging.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

/// False: there is nothing, or a link that leads to nothing. Throws Error for what is there and
/// cannot be looked at: a record without it would be none.
bool look_at(const fs::path& path, struct stat& at) {
  if (stat(path.c_str(), &at) == 0) return true;
  if (errno == ENOENT || errno == ENOTDIR || errno == ELOOP) return false;
  throw Error(path.string() + ": cannot be looked at (" + std::strerror(errno) +
              "); make it readable, or name another input");
}

/// What a run or a store made.
bool is_made(const fs::path& folder) {
  struct stat at {};
  return look_at(folder / "run.lock.yaml", at) || look_at(folder / "plumb-store", at);
}

class Walk {
 public:
  Walk(InputRecord& record, bool content) : record_(record), content_(content) {}

  void start() {
    struct stat at {};
    if (!look_at(record_.path, at)) return;
    if (S_ISDIR(at.st_mode))
      folder(record_.path, "", at);
    else
      file(record_.path, fs::path(record_.path).filename().string(), at);
    record_.digest = names_.hash();
    if (content_) record_.content = bytes_.hash();
  }

 private:
  void folder(const fs::path& path, const std::string& prefix,
              const struct stat& self) {                           // NOLINT: as deep as the folders
    if (!open_.insert({self.st_dev, self.st_ino}).second) return;  // a link to a folder around it
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end;
         entry.increment(error))
      names.push_back(entry->path().filename().string());
    if (error)
      throw Error(path.string() + ": cannot be listed (" + error.message() +
                  "); make it readable, or name another input");
    std::sort(names.begin(), names.end());
    for (const std::string& name : names) {
      if (io::is_staging_name(name)) continue;  // another run is about to leave its results here
      const fs::path inner = path / name;
      struct stat at {};
      if (!look_at(inner, at)) continue;
      if (!S_ISDIR(at.st_mode))
        file(inner.string(), prefix + name, at);
      else if (!is_made(inner))
        folder(inner, prefix + name + "/", at);
    }
    open_.erase({self.st_dev, self.st_ino});
  }

  void file(const std::string& path, const std::string& name, const struct stat& at) {
    if (!S_ISREG(at.st_mode)) return;
    ++record_.files;
    record_.bytes += static_cast<std::uint64_t>(at.st_size);
    names_.text(name);
    const std::int64_t seen[] = {at.st_size, at.st_mtim.tv_sec, at.st_mtim.tv_nsec};
    names_.bytes(seen, sizeof seen);
    if (!content_) return;
    bytes_.text(name);
    bytes_.bytes(&at.st_size, sizeof at.st_size);
    io::add_bytes(bytes_, path);
  }

  InputRecord& record_;
  const bool content_;
  Hasher names_, bytes_;
  std::set<std::pair<dev_t, ino_t>> open_;
};

}  // namespace

InputRecord input_record(const std::string& path, bool content) {
  InputRecord record;
  record.path = path;
  Walk(record, content).start();
  return record;
}

std::vector<std::string> input_paths(const Plan& plan) {
  std::set<std::string> paths;
  const auto add = [&](const ParameterValue& value) {
    const auto* path = std::get_if<std::string>(&value);
    if (path && !path->empty()) paths.insert(*path);
  };
  for (const PlannedStep& step : plan.steps)
    for (std::size_t p = 0; p < step.parameters.size(); ++p) {
      if (step.description->parameters[p].kind != ParameterKind::path) continue;
      const PlannedParameter& parameter = step.parameters[p];
      if (parameter.row < 0)
        add(parameter.value);
      else
        for (const ParameterValue& value :
             plan.repeats[parameter.repeat].rows[parameter.row].values)
          add(value);
    }
  return {paths.begin(), paths.end()};
}

Hash128 file_hash(const std::string& file) {
  Hasher hasher;
  io::add_bytes(hasher, file);
  return hasher.hash();
}

}  // namespace plumb
