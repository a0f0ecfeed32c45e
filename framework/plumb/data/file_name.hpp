#pragma once
/// The one rule for names that become a part of a path: of a step's file, of a pipeline or variant
/// whose results get a folder.

#include <string>
#include <string_view>

namespace plumb {

/// What is wrong with a name of a file or folder, as the end of a sentence ("is not a name for
/// ..."); empty if nothing is. A good name stays in the folder that it is put into, is seen there,
/// and leaves room for what a run adds to it.
std::string fault_of_file_name(std::string_view name);

}  // namespace plumb
