#include "licence_table.hpp"

#include <algorithm>
#include <iomanip>
#include <map>
#include <ostream>
#include <string>

namespace plumb::command {
namespace {

struct Module {
  std::string steps, reason;
};

std::string shown(const std::filesystem::path& module) {
  const auto shipped = Registry::shipped_folders();
  const bool is_shipped =
      std::find(shipped.begin(), shipped.end(), module.parent_path()) != shipped.end();
  return is_shipped ? module.filename().string() : module.string();
}

}  // namespace

void print_licences(std::ostream& out, const Registry& steps) {
  std::map<std::string, std::map<std::string, Module>> groups;  // by licences, then by file
  std::size_t width = 0;
  for (const StepDescription* step : steps.all()) {
    const Licence& licence = steps.licence_of(*step);
    const std::string file = shown(step->module);
    Module& module = groups[licence.text()][file];
    module.steps += (module.steps.empty() ? "" : ", ") + step->name;
    module.reason = licence.reason;
    width = std::max(width, file.size());
  }
  const char* between = "";
  for (const auto& [licences, modules] : groups) {
    out << between << licences << "\n";
    for (const auto& [file, module] : modules) {
      out << "  " << std::left << std::setw(static_cast<int>(width) + 2) << file << module.steps
          << "\n";
      if (!module.reason.empty()) out << "      " << module.reason << "\n";
    }
    between = "\n";
  }
}

}  // namespace plumb::command
