/// plumb migrate: a pipeline of an earlier release by the names of now.

#include "plumb/pipeline/migrate.hpp"

#include <iostream>

#include "command.hpp"
#include "command_line.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "replaced_file.hpp"

namespace plumb::command {
namespace fs = std::filesystem;
namespace {

struct Options {
  std::filesystem::path file, output;
};

void migrate(const Options& options) {
  std::error_code error;
  if (!options.output.empty() && fs::is_regular_file(options.output, error) &&
      !fs::equivalent(options.output, options.file, error))
    throw Error(options.output.string() +
                ": is there already; give -o a new name, or leave it out to replace the pipeline "
                "itself");
  const Migrated result = migrated(options.file, installed_steps());
  const auto& to = options.output.empty() ? options.file : options.output;
  if (!result.done.empty() || !options.output.empty()) replace_file(to, result.text, options.file);
  for (const Renaming& renaming : result.done) std::cout << renaming.done() << "\n";
  const std::size_t places = result.done.size();
  if (places == 0)
    std::cout << options.file.string() << ": nothing to do, all its names are those of now\n";
  else
    std::cout << to.string() << ": written, with " << counted(places, "changes") << "\n";
}

}  // namespace

void add_migrate(Command& program) {
  Command command = program.add_subcommand(
      "migrate", "Rewrites a pipeline or preset that uses names of an earlier release");
  auto options = std::make_shared<Options>();
  command.add_option("PIPELINE", options->file, "A pipeline or a preset (YAML)").required();
  command.add_option("-o,--output", options->output,
                     "File for the result; without it the pipeline itself is replaced");
  command.footer(
      "Comments, order and layout stay. Where a default has changed since, the former one is "
      "written out.\n"
      "Exit 1 and nothing written when the pipeline has mistakes, or a place cannot be "
      "rewritten.\n\n"
      "  plumb migrate my_pipeline.yaml");
  command.callback([options] { migrate(*options); });
}

}  // namespace plumb::command
