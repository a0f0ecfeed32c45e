/// plumb check, resolve, graph: what can be said of a pipeline without running it.

#include <iostream>

#include "command_line.hpp"
#include "pipeline_options.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/engine/plan/plan_text.hpp"
#include "plumb/engine/preflight.hpp"
#include "plumb/pipeline/print/graph.hpp"
#include "plumb/pipeline/print/table.hpp"
#include "untrusted.hpp"

namespace plumb::command {

void add_check(Command& program) {
  Command command = program.add_subcommand("check", "Checks a pipeline; nothing runs");
  auto options = std::make_shared<PipelineOptions>();
  options->add_to(command);
  options->overlay.needs_files = true;
  command.footer(
      "Prints every mistake with file:line:column, files that are not there too; or the passes of "
      "each loop, and with --plan the steps in the order in which they run. Exit 1 when there is a "
      "mistake.");
  auto untrusted = std::make_shared<Untrusted>();
  untrusted->add_to(command);
  auto with_plan = std::make_shared<bool>(false);
  command.add_flag("--plan", *with_plan,
                   "Also print what a run will do, step by step: what one call sees, how long "
                   "results live and why, which steps run together");
  command.callback([options, untrusted, with_plan] {
    untrusted->before_reading(*options);
    const Registry steps = untrusted->steps();
    const Plan plan = read_pipeline(options->file, options->overlay, steps);
    say_warnings(plan);
    untrusted->before_running(plan, steps, {});
    preflight(plan, steps);
    std::cout << passes_table(plan);
    if (*with_plan) std::cout << (plan.repeats.empty() ? "" : "\n") << plan_text(plan) << "\n";
    std::cout << options->file.string() << ": good, " << counted(plan.steps.size(), "steps")
              << "\n";
  });
}

void add_resolve(Command& program) {
  Command command = program.add_subcommand(
      "resolve", "Prints the pipeline after presets and settings, each value with its origin");
  auto options = std::make_shared<PipelineOptions>();
  options->add_to(command);
  options->overlay.open = true;
  command.callback([options] {
    const Registry steps = installed_steps();
    const Plan plan = read_pipeline(options->file, options->overlay, steps);
    say_warnings(plan);
    std::cout << plan.resolved;
  });
}

void add_graph(Command& program) {
  Command command =
      program.add_subcommand("graph", "Prints the wires of a pipeline as a Mermaid or DOT graph");
  auto options = std::make_shared<PipelineOptions>();
  auto format = std::make_shared<std::string>("mermaid");
  options->add_to(command);
  options->overlay.open = true;
  command.add_option("--format", *format, "mermaid or dot")
      .one_of({"mermaid", "dot"})
      .capture_default_str();
  command.callback([options, format] {
    const Registry steps = installed_steps();
    const Plan plan = read_pipeline(options->file, options->overlay, steps);
    say_warnings(plan);
    std::cout << (*format == "dot" ? dot_graph(plan) : mermaid_graph(plan));
  });
}

}  // namespace plumb::command
