#include "pipeline_options.hpp"

#include <iostream>
#include <set>

namespace plumb::command {

std::string fault_of_set(const std::string& text) {
  const auto equals = text.find('=');
  if (equals != std::string::npos && equals > 0 && equals + 1 < text.size()) return "";
  return "expected NAME=VALUE, as in input=DIR, not '" + text + "'";
}

void say_warnings(const Plan& plan) {
  static std::set<std::string> said;  // compare reads the same files again and again
  std::vector<std::string> lines;
  for (const Renaming& renaming : plan.renamings) lines.push_back(renaming.warning());
  lines.insert(lines.end(), plan.warnings.begin(), plan.warnings.end());
  for (const std::string& line : lines)
    if (said.insert(line).second) std::cerr << line << "\n";
}

}  // namespace plumb::command
