/// plumb_manifest MODULE.so OUT.json: writes what the module's steps declare. The build runs it for
/// each module.

#include <exception>
#include <fstream>
#include <iostream>

#include "plumb/plugin/manifest.hpp"
#include "plumb/plugin/registry.hpp"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: plumb_manifest MODULE.so OUT.json\n";
    return 2;
  }
  try {
    plumb::Manifest manifest{plumb::abi_tag(), {}};
    for (const plumb::Step* step : plumb::load_module(argv[1]))
      manifest.steps.push_back(step->description());
    std::ofstream out(argv[2]);
    out << plumb::manifest_text(manifest);
    out.close();
    if (!out) throw std::runtime_error(std::string(argv[2]) + ": cannot be written");
    return 0;
  } catch (const std::exception& e) {
    std::cerr << "plumb_manifest: " << e.what() << '\n';
    return 1;
  }
}
