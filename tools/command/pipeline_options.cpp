#include "pipeline_options.hpp"

#include <iostream>
#include <set>

namespace plumb::command {

void say_renamings(const Plan& plan) {
  static std::set<std::string> said;  // compare reads the same files again and again
  for (const Renaming& renaming : plan.renamings)
    if (const std::string line = renaming.warning(); said.insert(line).second)
      std::cerr << line << "\n";
}

}  // namespace plumb::command
