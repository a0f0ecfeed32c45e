#include "usage.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <vector>

#include "plumb/pipeline/yaml/diagnostics.hpp"

namespace plumb::command {
namespace {

/// The sub-command that was given, the innermost: the program itself when there is none.
struct Chosen {
  const CLI::App* command;
  std::string words;  ///< "plumb cache verify"
};

Chosen chosen_of(const CLI::App& program) {
  Chosen chosen{&program, program.get_name()};
  for (auto inner = program.get_subcommands(); !inner.empty();
       inner = chosen.command->get_subcommands())
    chosen = {inner.front(), chosen.words + " " + inner.front()->get_name()};
  return chosen;
}

/// Commands that are started by hand.
std::vector<std::string> commands_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* inner : command.get_subcommands({}))
    if (inner->get_name() != "worker") names.push_back(inner->get_name());
  return names;
}

/// The long names of options, but those of an earlier release, which are hidden.
std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    if (!option->get_group().empty())
      names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
  return names;
}

bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && !std::isdigit(static_cast<unsigned char>(word[1]));
}

std::string of_option(const CLI::App& program, const Chosen& chosen, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  if (chosen.command->get_option_no_throw(name))
    return "'" + name + "' is an option of '" + chosen.words + "'; give it behind these words";
  std::vector<std::string> known = options_of(*chosen.command);
  if (chosen.command != &program)
    for (const std::string& option : options_of(program)) known.push_back(option);
  const std::string bare = name.substr(std::min(name.find_first_not_of('-'), name.size()));
  constexpr std::size_t least_letters = 3;  // any two short ones are near each other
  const std::string near = bare.size() < least_letters ? "" : pipeline::nearest(bare, known);
  return "'" + chosen.words + "' has no option '" + name + "'" +
         (near.empty() ? "" : "; did you mean '--" + near + "'?");
}

std::string of_command(const Chosen& chosen, const std::string& word) {
  const std::vector<std::string> known = commands_of(*chosen.command);
  const std::string near = pipeline::nearest(word, known);
  return "'" + chosen.words + "' has no command '" + word + "'; " +
         (near.empty() ? "known: " + pipeline::joined(known) : "did you mean '" + near + "'?");
}

}  // namespace

std::string usage_sentence(const CLI::App& program, const CLI::Error& error) {
  const Chosen chosen = chosen_of(program);
  const std::vector<std::string> known = commands_of(*chosen.command);
  std::vector<std::string> stray = program.remaining(true);
  std::erase(stray, "--");
  std::string sentence;
  if (!stray.empty() && is_option(stray.front()))
    sentence = of_option(program, chosen, stray.front());
  else if (!stray.empty() && !known.empty())
    sentence = of_command(chosen, stray.front());
  else if (!stray.empty())
    sentence = "'" + stray.front() + "' is one word more than '" + chosen.words +
               "' takes; an option takes one value each time, and a value with blanks stands in "
               "quotes";
  else if (chosen.command == &program && dynamic_cast<const CLI::RequiredError*>(&error))
    sentence = "a command is missing; known: " + pipeline::joined(known);
  else
    sentence = error.what();
  return sentence + (sentence.ends_with('?') ? " `" : "; `") + chosen.words +
         " --help` says what there is";
}

}  // namespace plumb::command
