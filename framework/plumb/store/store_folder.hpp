#pragma once
/// The folder of a store: made for its user alone, or judged before it is used.

#include <filesystem>
#include <string>

#include "plumb/store/store.hpp"

namespace plumb {

/// Opens it, or makes it where it is not there. Throws Error, with a sentence that begins with
/// `title`: it is no store and not empty, a store of another format, one that others own or may
/// write, or cannot be written.
void open_store_folder(const std::filesystem::path& folder, StoreRole role, Whose whose,
                       const std::string& title);

}  // namespace plumb
