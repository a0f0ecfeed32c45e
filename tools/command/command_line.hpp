#pragma once
/// The command line as the commands declare it: sub-commands, options, flags. CLI11 reads it behind
/// these classes; its headers cost seconds in each file that includes them, so only
/// command_line.cpp and usage.cpp do. What a function does is what the one of that name does in
/// CLI11, unless it says otherwise.

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace plumb::command {

/// An option, a flag or a positional. A handle: the program owns it. Each function returns it
/// again, for the next one.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option required(bool is = true);
  /// `fault` says what is wrong with a value; "" for nothing.
  Option check(std::function<std::string(const std::string& value)> fault);
  Option one_of(const std::vector<std::string>& words);
  Option range(int least, int most);
  Option positive();
  /// `other`, of the same command, by its name: "--set", "PIPELINE".
  Option needs(const std::string& other);
  Option excludes(const std::string& other);
  /// Of an option that may be given again: one value each time, so that a positional may follow.
  Option one_value_each();
  Option expected(int values);
  /// The heading that it stands under in the help; "" hides it.
  Option group(std::string name);
  /// What the help shows for a value.
  Option type_name(std::string name);
  /// What the help shows as the default: a text, or what the variable holds now.
  Option default_str(std::string text);
  Option capture_default_str();

 private:
  CLI::Option* option_;
};

/// The program or a sub-command. A handle too.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  /// Takes over what is set here so far: footer, fallthrough, the most sub-commands.
  Command add_subcommand(std::string name, std::string about);

  /// `names`: "-o,--output"; without dashes a positional. `value` must live as long as the program.
  /// T: std::string, std::filesystem::path, a vector of either, int, unsigned, std::uint64_t,
  /// double.
  template <class T>
  Option add_option(std::string names, T& value, std::string about);
  /// Hands each value to `take`.
  Option add_option_function(std::string names,
                             const std::function<void(const std::string& value)>& take,
                             std::string about);
  /// "--times,!--no-times": the second one makes `value` false.
  Option add_flag(std::string names, bool& value, std::string about);
  /// One that was added, by any of its names. Throws CLI::OptionNotFound.
  Option get_option(const std::string& name);

  void footer(std::string text);
  /// Runs when the whole command line is good. May throw UsageError, Error and ExitWith.
  void callback(std::function<void()> run);
  void require_subcommand(std::size_t least, std::size_t most);
  /// What is not known here is looked for in the command above.
  void fallthrough();

  /// Asked by a callback: whether a sub-command was given; the first option that was given an empty
  /// value ("" for a hidden one).
  bool has_subcommand() const;
  std::optional<std::string> option_without_value() const;

 private:
  CLI::App* app_;
};

class Program {
 public:
  Program(std::string name, std::string about);
  ~Program();

  Command command();
  /// Adds --version.
  void add_version(const std::string& text);
  /// Reads the command line and runs the callback of the command that it gives, whose exceptions
  /// pass; or prints help or version on standard output. False when the command line is wrong,
  /// which standard error says then (usage.hpp).
  bool parse(int argc, const char* const* argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace plumb::command
