#include "replaced_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "plumb/data/error.hpp"
#include "plumb/data/io/regular_file.hpp"

namespace plumb::command {
namespace fs = std::filesystem;
namespace {

/// The new file until it has its name; removed when it does not get it.
class Beside {
 public:
  explicit Beside(const fs::path& file)
      : file_(file), name_(file.parent_path() / ("." + file.filename().string() + ".XXXXXX")) {
    descriptor_ = mkostemp(name_.data(), O_CLOEXEC);
    if (descriptor_ < 0) fail();
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;
  ~Beside() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!in_place_) unlink(name_.c_str());
  }

  void write(const std::string& text, const struct stat& like) {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t n = ::write(descriptor_, text.data() + done, text.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail();
      done += static_cast<std::size_t>(n);
    }
    if (fchown(descriptor_, like.st_uid, like.st_gid) != 0 && errno != EPERM) fail();
    if (fchmod(descriptor_, like.st_mode & 0777) != 0 || fsync(descriptor_) != 0) fail();
    if (close(std::exchange(descriptor_, -1)) != 0) fail();
  }

  void put_in_place() {
    if (rename(name_.c_str(), file_.c_str()) != 0) fail();
    in_place_ = true;
    const int folder = open(file_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    fsync(folder);
    close(folder);
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(file_.string() + ": cannot be written (" + std::strerror(errno) +
                "); nothing was changed");
  }

  fs::path file_;
  std::string name_;
  int descriptor_ = -1;
  bool in_place_ = false;
};

using Status = struct stat;

/// Whose a file is that is made without a word of its permissions, and what may be done with it.
Status of_new_file() {
  const mode_t mask = umask(0);
  umask(mask);
  Status status{};
  status.st_uid = geteuid(), status.st_gid = getegid();
  status.st_mode = 0666 & ~mask;
  return status;
}

}  // namespace

void replace_file(const fs::path& file, const std::string& text, const fs::path& like,
                  const std::string& option) {
  std::error_code error;
  fs::path place = fs::weakly_canonical(fs::absolute(file), error);
  if (error) place = fs::absolute(file);
  if (const std::string other = io::other_than_file(place); !other.empty())
    throw Error(file.string() + ": is " + other + "; name a file with " + option);
  struct stat status {};
  const bool there = stat(place.c_str(), &status) == 0;
  if (there && access(place.c_str(), W_OK) != 0)
    throw Error(file.string() + ": may not be written; change its permissions, or name another " +
                "file with " + option);
  if (!there && like.empty())
    status = of_new_file();
  else if (!there && stat(like.c_str(), &status) != 0)
    throw Error(like.string() + ": is gone; nothing was written");
  Beside beside(place);
  beside.write(text, status);
  beside.put_in_place();
}

}  // namespace plumb::command
