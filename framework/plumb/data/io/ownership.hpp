#pragma once
/// Who may have put there what lies at a path: what OpenSSH asks of its keys, asked of modules and
/// stores.

#include <filesystem>
#include <optional>
#include <string>

namespace plumb::io {

/// How a file or folder is judged.
enum class Judging {
  entry,  ///< must belong to root or to this user, and nobody else may write it
  above,  ///< a folder in which what matters lies: the same, but it may be sticky, as /tmp is: what
          ///< lies in it belongs to whom it belongs
  lenient  ///< a folder above that counts only where everybody may write into it, and it is not
           ///< sticky
};

/// What is wrong with a path, and the command that cures it.
struct Looseness {
  std::filesystem::path where;
  std::string what;               ///< "may be written by its group (mode 0775)"
  std::string command, argument;  ///< chmod, go-w

  /// "chmod go-w '/opt/modules'"; with "-R" of all that lies in it, too.
  std::string cure(const std::string& option = "") const {
    return command + (option.empty() ? "" : " " + option) + " " + argument + " '" + where.string() +
           "'";
  }
};

/// None when nobody but root, this user and `also` (the number of a user) can have written it.
/// Links are followed: resolve them before.
std::optional<Looseness> looseness_of(const std::filesystem::path& path, Judging judging,
                                      std::optional<unsigned> also = std::nullopt);

}  // namespace plumb::io
