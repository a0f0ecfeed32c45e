#pragma once
/// Which files may be loaded as code. Judged as OpenSSH judges its keys: nobody but root and this
/// user may have put there what lies at the path, or may put something else there.

#include <filesystem>
#include <string>

namespace plumb {

/// libplumb itself, and its folder.
std::filesystem::path this_library();
std::filesystem::path folder_of_this_library();

/// "" for a folder in which modules may be looked for, or what is wrong and the cure. The folder
/// itself and all above it are judged, links resolved. Of the folders in which libplumb lies only
/// those are refused that everybody may write: who can change them has the program already; for the
/// same reason whoever owns libplumb may own modules.
std::string fault_of_folder(const std::filesystem::path& folder);

/// "" for a module or manifest that may be read, or what is wrong and the cure: it must be a
/// regular file, or a link to one, judged as a folder is.
std::string fault_of_file(const std::filesystem::path& file);

}  // namespace plumb
