#include "simulate/output_folder.hpp"

#include <cerrno>
#include <cstring>
#include <optional>

#include "plumb/data/error.hpp"
#include "simulate/scene.hpp"

namespace plumb::simulate {
namespace {

namespace fs = std::filesystem;

constexpr const char *scene_file = "scene.yaml", *hash_line = "# hash of all files: ";

/// The last line of scene.yaml, by which an unchanged simulation is known.
std::string last_line(const std::map<std::string, Hash128>& hashes, const std::string& scene) {
  Hasher all;
  for (const auto& [name, hash] : hashes) {
    all.text(name);
    all.bytes(&hash, sizeof hash);
  }
  all.text(scene);
  return hash_line + all.hash().text() + "\n";
}

[[noreturn]] void refuse(const fs::path& shown, const std::string& what) {
  throw Error(shown.string() + ": " + what + "; name another folder with -o");
}

/// Looks at all files of a simulation: those in the folder itself, and those in frames/.
class Simulation {
 public:
  Simulation(const io::Folder& folder, const fs::path& shown) : folder_(folder), shown_(shown) {}

  io::Listing listing() {
    const auto names = names_in(folder_);
    if (names.empty()) return {};
    constexpr std::size_t longest = std::size_t{1} << 20;
    const auto scene = folder_.text(scene_file, longest);
    if (!scene || !scene->starts_with(scene_mark))
      refuse(shown_, "holds something that the simulator did not make");
    for (const std::string& name : names)
      if (name == "frames" && folder_.inode_of(name).value_or(0) != 0)
        look_at_frames();
      else
        look_at(folder_, name, name);
    hashes_.erase(scene_file);
    const auto end = scene->rfind(hash_line);
    if (end == scene->npos || scene->substr(end) != last_line(hashes_, scene->substr(0, end)))
      refuse(shown_, "was changed since the simulator made it, or is of an earlier Plumb");
    return std::move(listing_);
  }

 private:
  std::vector<std::string> names_in(const io::Folder& folder) const {
    auto names = folder ? folder.names() : std::nullopt;
    if (!names) refuse(shown_, std::string("cannot be listed (") + std::strerror(errno) + ")");
    return std::move(*names);
  }

  void look_at_frames() {
    const io::Folder frames = folder_.inner("frames");
    listing_.folders.emplace_back("frames");
    for (const std::string& name : names_in(frames)) look_at(frames, name, "frames/" + name);
  }

  void look_at(const io::Folder& folder, const std::string& leaf, const std::string& name) {
    const auto file = folder.hashed(leaf);
    if (!file && errno != EINVAL && errno != ELOOP)
      refuse(shown_, "'" + name + "' cannot be read (" + std::strerror(errno) + ")");
    if (!file) refuse(shown_, "'" + name + "' is something that the simulator did not make");
    hashes_[name] = file->hash;
    listing_.files.push_back({name, file->stamp});
  }

  const io::Folder& folder_;
  const fs::path& shown_;
  std::map<std::string, Hash128> hashes_;
  io::Listing listing_;
};

}  // namespace

OutputFolder::OutputFolder(const fs::path& place, const std::vector<std::string>& folders)
    : staged_(place, "name another folder with -o",
              [](const io::Folder& folder, const fs::path& shown) {
                return Simulation(folder, shown).listing();
              }) {
  for (const std::string& name : folders) staged_.add_folder(name);
}

void OutputFolder::write(const std::string& name, const std::string& bytes) {
  staged_.write(name, [&](const io::Take& take) { take(bytes); });
  const std::lock_guard lock(mutex_);
  hashes_[name] = hash_of(bytes);
}

std::string OutputFolder::finish(const std::string& scene) {
  staged_.write(scene_file, [&](const io::Take& take) { take(scene + last_line(hashes_, scene)); });
  return staged_.finish();
}

}  // namespace plumb::simulate
