/// plumb schema: the JSON Schema of pipelines, from what the installed steps declare.

#include "plumb/pipeline/print/schema.hpp"

#include <fstream>
#include <iostream>

#include "command.hpp"
#include "command_line.hpp"
#include "plumb/data/error.hpp"
#include "plumb/data/io/file_text.hpp"

namespace plumb::command {

namespace {

/// Whether a schema that this command wrote lies there, and nothing of the user's.
bool is_ours(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  return io::FileBytes(file).view().find("\"title\": \"Plumb pipeline\"") != std::string_view::npos;
}

}  // namespace

void add_schema(Command& program) {
  Command command = program.add_subcommand(
      "schema", "Writes the JSON Schema of pipelines, for editors and a second judge");
  auto folder = std::make_shared<std::filesystem::path>();
  command.add_option("-o,--output", *folder,
                     "Folder for pipeline.schema.json; without it, it is printed");
  command.callback([folder] {
    const std::string text = pipeline_schema(installed_steps());
    if (folder->empty()) {
      std::cout << text;
      return;
    }
    std::error_code error;
    std::filesystem::create_directories(*folder, error);
    const auto file = *folder / "pipeline.schema.json";
    if (std::filesystem::exists(std::filesystem::symlink_status(file, error)) && !is_ours(file))
      throw Error(file.string() +
                  ": is there already and is not a schema of Plumb; move it away, or give another "
                  "folder with -o");
    std::ofstream out(file);
    out << text;
    out.close();
    if (!out) throw Error(file.string() + ": cannot be written; give a folder that can be with -o");
  });
}

}  // namespace plumb::command
