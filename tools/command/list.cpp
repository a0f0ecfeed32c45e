/// plumb list, inspect: what steps there are, from their manifests alone.

#include <iomanip>
#include <iostream>

#include "command.hpp"
#include "command_line.hpp"
#include "licence_table.hpp"
#include "plumb/data/error.hpp"
#include "plumb/pipeline/yaml/diagnostics.hpp"
#include "plumb/pipeline/yaml/former_names.hpp"
#include "plumb/plugin/manifest.hpp"

namespace plumb::command {
namespace {

std::string word_of(const InputDescription& input) {
  switch (input.access) {
    case Access::item:
      return "";
    case Access::ends:
      return "of both ends";
    case Access::each:
      return "all, one at a time";
    case Access::several:
      return "any number, labelled";
    case Access::part:
      return input.sees;
  }
  return "";
}

std::string type_text(const Type& type) {
  return type.name + (type.kind ? ", one per " + type.kind->name : "");
}

void print_step(const StepDescription& step, const Licence& licence) {
  const std::string base = step.base();
  const bool vowel = std::string("AEIOU").find(base.front()) != std::string::npos;
  std::cout << step.name << "  version " << step.version << (vowel ? ", an " : ", a ") << base
            << "\n  " << step.summary << "\n";
  if (!step.source.empty()) std::cout << "  Source: " << step.source << "\n";
  std::cout << "  Licence of its module: " << licence.text() << "\n";
  if (!licence.reason.empty()) std::cout << "      " << licence.reason << "\n";
  std::cout << "\nInputs\n";
  for (const auto& port : step.inputs) {
    const std::string how = word_of(port);
    std::cout << "  " << std::left << std::setw(14) << port.name << type_text(*port.type)
              << (how.empty() ? "" : " (" + how + ")") << (port.optional ? ", may be left out" : "")
              << "\n"
              << std::string(16, ' ') << port.doc << "\n";
  }
  if (step.inputs.empty()) std::cout << "  none\n";
  std::cout << "\nOutputs\n";
  for (const auto& port : step.outputs)
    std::cout << "  " << std::left << std::setw(14) << port.name << type_text(*port.type)
              << (port.over.empty() ? "" : " of '" + port.over + "'") << "\n"
              << std::string(16, ' ') << port.doc << "\n";
  std::cout << "\nParameters\n";
  for (const auto& p : step.parameters) {
    std::cout << "  " << p.name << ": " << range_text(p) << "; "
              << (p.required ? std::string("required") : "default " + written(p, p.standard))
              << "\n      " << p.doc << "\n";
    for (const auto& choice : p.choices)
      std::cout << "        " << choice.name << ": " << choice.doc << "\n";
    if (!p.source.empty()) std::cout << "      Source: " << p.source << "\n";
  }
  if (step.parameters.empty()) std::cout << "  none\n";
}

void print_steps(const Registry& steps) {
  for (const StepDescription* step : steps.all())
    std::cout << std::left << std::setw(28) << step->name << std::setw(13) << step->base()
              << step->summary << "\n";
}

}  // namespace

void add_list(Command& program) {
  Command command = program.add_subcommand("list", "Lists the steps that pipelines can use");
  auto licences = std::make_shared<bool>(false);
  command.add_flag("--licences", *licences,
                   "What whoever loads a module accepts: its own licence and those of the "
                   "libraries that it brings, with its steps and the reason");
  command.callback([licences] {
    const Registry steps = installed_steps();
    if (*licences)
      print_licences(std::cout, steps);
    else
      print_steps(steps);
    for (const Refusal& refusal : steps.refused())
      std::cerr << "refused: " << refusal.file.string() << ": " << refusal.why << "\n";
  });
}

void add_inspect(Command& program) {
  Command command = program.add_subcommand(
      "inspect", "Shows one step's ports, parameters, units, ranges, defaults, source and licence");
  auto name = std::make_shared<std::string>();
  auto as_json = std::make_shared<bool>(false);
  command.add_option("STEP", *name, "FAMILY.NAME, as in `plumb list`").required();
  command.add_flag("--json", *as_json, "As JSON");
  command.callback([name, as_json] {
    const Registry steps = installed_steps();
    const StepDescription* step = steps.find(*name);
    if (!step) {
      std::vector<std::string> names;
      for (const StepDescription* known : steps.all()) names.push_back(known->name);
      const auto now = shipped_former_names().steps.find(*name);
      if (const auto left = steps.left_out().find(*name); left != steps.left_out().end())
        throw Error("the step '" + *name + "' is not in this build: " + left->second + ".");
      const std::string close = pipeline::nearest(*name, names);
      throw Error("there is no step '" + *name + "'." +
                  (now != shipped_former_names().steps.end()
                       ? " It is called '" + now->second + "' now."
                   : close.empty() ? ""
                                   : " Did you mean '" + close + "'?") +
                  " `plumb list` shows all.");
    }
    if (*as_json)
      std::cout << step_json(*step, steps.licence_of(*step)) << "\n";
    else
      print_step(*step, steps.licence_of(*step));
  });
}

}  // namespace plumb::command
