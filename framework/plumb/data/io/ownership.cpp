#include "plumb/data/io/ownership.hpp"

#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace plumb::io {
namespace {

/// "'alice'", or "number 1234" of a user without a name.
std::string name_of_user(uid_t user) {
  std::array<char, 4096> text;
  passwd entry{}, *found = nullptr;
  if (getpwuid_r(user, &entry, text.data(), text.size(), &found) == 0 && found)
    return "'" + std::string(found->pw_name) + "'";
  return "number " + std::to_string(user);
}

std::string octal(mode_t mode) {
  std::array<char, 8> text;
  std::snprintf(text.data(), text.size(), "%04o", static_cast<unsigned>(mode & 07777));
  return text.data();
}

}  // namespace

std::optional<Looseness> looseness_of(const std::filesystem::path& path, Judging judging,
                                      std::optional<unsigned> also) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0)
    return Looseness{path, std::string("cannot be looked at (") + std::strerror(errno) + ")", "ls",
                     "-ld"};
  const uid_t self = geteuid();
  if (judging != Judging::lenient && info.st_uid != 0 && info.st_uid != self &&
      !(also && info.st_uid == *also))
    return Looseness{path, "belongs to user " + name_of_user(info.st_uid), "chown",
                     std::to_string(self)};
  if (judging != Judging::entry && S_ISDIR(info.st_mode) && (info.st_mode & S_ISVTX))
    return std::nullopt;
  const bool group = judging != Judging::lenient && (info.st_mode & S_IWGRP),
             all = info.st_mode & S_IWOTH;
  if (!group && !all) return std::nullopt;
  return Looseness{path,
                   std::string("may be written by ") + (all ? "everybody" : "its group") +
                       " (mode " + octal(info.st_mode) + ")",
                   "chmod", "go-w"};
}

}  // namespace plumb::io
