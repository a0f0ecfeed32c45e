/// Loading of modules. A module is never unloaded: static objects and thread-locals of its
/// templates would dangle.

#include <dlfcn.h>

#include "plumb/plugin/module.hpp"
#include "plumb/plugin/registry.hpp"
#include "plumb/plugin/trusted_file.hpp"

namespace plumb {

const char* abi_tag() {
  static const std::string tag = PLUMB_ABI_TAG + abi_layout();
  return tag.c_str();
}

std::vector<const Step*> load_module(const std::filesystem::path& file) {
  const std::string name = file.string();
  // Only root and this user can change what lies there between here and dlopen: that is what is
  // asked.
  if (const std::string fault = fault_of_file(file); !fault.empty())
    throw Error(name + ": is not loaded: " + fault);
  void* handle =
      dlopen(std::filesystem::canonical(file).c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (!handle) {
    const char* why = dlerror();
    throw Error(name + ": cannot be loaded: " + (why ? why : "unknown reason"));
  }
  using Entry = const PlumbModule* (*)();
  const auto entry = reinterpret_cast<Entry>(dlsym(handle, "plumb_module"));
  if (!entry) throw Error(name + ": is not a module of Plumb: it has no function plumb_module");
  const PlumbModule* module = nullptr;
  try {
    module = entry();
  } catch (const std::exception& e) {  // what it defines contradicts what is there
    throw Error(name + ": cannot be used: " + e.what());
  }
  if (!module || module->magic != module_magic)
    throw Error(name + ": is not a module of Plumb: its table starts with another number");
  if (module->table_version != module_table_version || std::string(module->abi_tag) != abi_tag())
    throw Error(name + ": was built for another Plumb: it has '" + module->abi_tag + "' (table " +
                std::to_string(module->table_version) + "), this one has '" + abi_tag() +
                "' (table " + std::to_string(module_table_version) +
                "); build the module again with this SDK");
  return {module->steps, module->steps + module->count};
}

}  // namespace plumb
