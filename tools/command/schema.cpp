/// plumb schema: the JSON Schema of pipelines, from what the installed steps declare.

#include "plumb/pipeline/print/schema.hpp"

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>

#include "command.hpp"
#include "plumb/data/error.hpp"

namespace plumb::command {

void add_schema(CLI::App& app) {
  auto* command = app.add_subcommand(
      "schema", "Writes the JSON Schema of pipelines, for editors and a second judge");
  auto folder = std::make_shared<std::filesystem::path>();
  command->add_option("-o,--output", *folder,
                      "Folder for pipeline.schema.json; without it, it is printed");
  command->callback([folder] {
    const std::string text = pipeline_schema(installed_steps());
    if (folder->empty()) {
      std::cout << text;
      return;
    }
    std::error_code error;
    std::filesystem::create_directories(*folder, error);
    const auto file = *folder / "pipeline.schema.json";
    std::ofstream out(file);
    out << text;
    out.close();
    if (!out) throw Error(file.string() + ": cannot be written; give a folder that can be with -o");
  });
}

}  // namespace plumb::command
