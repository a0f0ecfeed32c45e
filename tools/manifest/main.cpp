/// plumb_manifest MODULE.so OUT.json [LICENCE [REASON]]: writes what the module's steps declare,
/// and the licences that it comes under. The build runs it for each module.

#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "plumb/plugin/manifest.hpp"
#include "plumb/plugin/registry.hpp"

namespace {

/// As the command line states it. Throws where it is none that a manifest may have.
plumb::Licence licence_of(int argc, char** argv) {
  if (argc < 4) return {};
  if (const std::string fault = plumb::fault_of_licence(argv[3]); !fault.empty())
    throw std::runtime_error(std::string(argv[1]) + ": " + fault);
  return {argv[3], argc > 4 ? argv[4] : ""};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 5) {
    std::cerr << "usage: plumb_manifest MODULE.so OUT.json [LICENCE [REASON]]\n";
    return 2;
  }
  try {
    plumb::Manifest manifest{plumb::abi_tag(), {}, licence_of(argc, argv)};
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
