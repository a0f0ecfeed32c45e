#pragma once
/// The entry point of a module: one C function that returns a versioned table, and first of all the
/// ABI tag. A module ends with PLUMB_MODULE(StepA, StepB, ...), at global scope, in exactly one of
/// its files.

#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>

#include "plumb/plugin/declaration.hpp"

#define PLUMB_SDK_ABI 3  ///< raised when anything in data/ or plugin/ changes its layout

#define PLUMB_TEXT_(x) #x
#define PLUMB_TEXT(x) PLUMB_TEXT_(x)
/// What must be the same in a module and in libplumb: SDK, compiler, standard library. How values
/// lie in memory is compared type by type (define_type).
#define PLUMB_ABI_TAG                                                                             \
  "plumb-sdk " PLUMB_TEXT(PLUMB_SDK_ABI) ", gcc " PLUMB_TEXT(__GNUC__) ", libstdc++ " PLUMB_TEXT( \
      _GLIBCXX_RELEASE) " cxx11-abi " PLUMB_TEXT(_GLIBCXX_USE_CXX11_ABI)

extern "C" {
/// Only the first three members are read before the tag is seen to fit.
struct PlumbModule {
  std::uint32_t magic;          ///< 0x504c554d
  std::uint32_t table_version;  ///< 1
  const char* abi_tag;
  std::size_t count;
  plumb::Step* const* steps;  ///< live until the process ends
};
}

namespace plumb {

inline constexpr std::uint32_t module_magic = 0x504c554d;
inline constexpr std::uint32_t module_table_version = 1;

/// How what crosses the boundary lies in memory here.
inline std::string abi_layout() {
  return ", port " + std::to_string(sizeof(PortInput)) + "/" + std::to_string(sizeof(PortOutput)) +
         ", type " + std::to_string(sizeof(Type)) + "/" + std::to_string(sizeof(TypeCode));
}

/// The table of a module with the steps S.
template <class... S>
const PlumbModule* module_of(const char* abi_tag) {
  static std::tuple<StepOf<S>...> steps;
  static Step* const list[] = {&std::get<StepOf<S>>(steps)...};
  static const std::string tag = std::string(abi_tag) + abi_layout();
  static const PlumbModule table = {module_magic, module_table_version, tag.c_str(), sizeof...(S),
                                    list};
  return &table;
}

}  // namespace plumb

#define PLUMB_MODULE(...)                                                               \
  extern "C" __attribute__((visibility("default"))) const PlumbModule* plumb_module() { \
    return plumb::module_of<__VA_ARGS__>(PLUMB_ABI_TAG);                                \
  }
