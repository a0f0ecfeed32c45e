#pragma once
/// A file with new content, whole or not at all.

#include <filesystem>
#include <string>

namespace plumb::command {

/// Puts `text` at `file`, where a link leads: written beside it, synced, renamed. It gets the
/// permissions of what was there, or of `like`; without that those of any new file. `option` names
/// the file on the command line. Throws Error; what was there stays then.
void replace_file(const std::filesystem::path& file, const std::string& text,
                  const std::filesystem::path& like, const std::string& option = "-o");

}  // namespace plumb::command
