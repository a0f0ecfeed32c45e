#pragma once
/// Which build of its code a module is, whatever folder it lies in.

#include <filesystem>
#include <string>

namespace plumb {

/// The identity that the linker gave a shared library (its GNU build ID, a hash of the code), in
/// hexadecimal: another one after another compilation of other code, the same after installation.
/// Of a file without one a hash of all its bytes. Throws Error when it cannot be read.
std::string build_of(const std::filesystem::path& library);

/// Of the libraries beside libplumb that modules may take kernels from (libplumb_*), together.
const std::string& build_of_libraries();

}  // namespace plumb
