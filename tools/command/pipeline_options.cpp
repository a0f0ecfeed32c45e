#include "pipeline_options.hpp"

#include <iostream>
#include <set>
#include <vector>

#include "command_line.hpp"

namespace plumb::command {

std::string fault_of_set(const std::string& text) {
  const auto equals = text.find('=');
  if (equals != std::string::npos && equals > 0 && equals + 1 < text.size()) return "";
  return "expected NAME=VALUE, as in input=DIR, not '" + text + "'";
}

void PipelineOptions::add_to(Command& command) {
  command.add_option("PIPELINE", file, "A pipeline or a preset (YAML)").required();
  command
      .add_option("--preset", overlay.presets,
                  "A preset to lay over the pipeline; may be given again")
      .one_value_each();
  command
      .add_option("--set", overlay.sets,
                  "A parameter, a row or a step's parameter: input=DIR, voxel_size=0.2m, "
                  "coarse.kept.pairs_per_cluster=30; a '$' in it is written '$$'; may be given "
                  "again")
      .one_value_each()
      .check(fault_of_set);
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
