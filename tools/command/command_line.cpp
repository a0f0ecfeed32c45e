#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "usage.hpp"

namespace plumb::command {

Option Option::required(bool is) {
  option_->required(is);
  return *this;
}

Option Option::check(std::function<std::string(const std::string&)> fault) {
  option_->check(std::move(fault));
  return *this;
}

Option Option::one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

Option Option::range(int least, int most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option Option::positive() {
  option_->check(CLI::PositiveNumber);
  return *this;
}

Option Option::needs(const std::string& other) {
  option_->needs(other);
  return *this;
}

Option Option::excludes(const std::string& other) {
  option_->excludes(other);
  return *this;
}

Option Option::one_value_each() {
  option_->allow_extra_args(false);
  return *this;
}

Option Option::expected(int values) {
  option_->expected(values);
  return *this;
}

Option Option::group(std::string name) {
  option_->group(std::move(name));
  return *this;
}

Option Option::type_name(std::string name) {
  option_->type_name(std::move(name));
  return *this;
}

Option Option::default_str(std::string text) {
  option_->default_str(std::move(text));
  return *this;
}

Option Option::capture_default_str() {
  option_->capture_default_str();
  return *this;
}

Command Command::add_subcommand(std::string name, std::string about) {
  return Command(*app_->add_subcommand(std::move(name), std::move(about)));
}

template <class T>
Option Command::add_option(std::string names, T& value, std::string about) {
  return Option(*app_->add_option(std::move(names), value, std::move(about)));
}
template Option Command::add_option(std::string, std::string&, std::string);
template Option Command::add_option(std::string, std::filesystem::path&, std::string);
template Option Command::add_option(std::string, std::vector<std::string>&, std::string);
template Option Command::add_option(std::string, std::vector<std::filesystem::path>&, std::string);
template Option Command::add_option(std::string, int&, std::string);
template Option Command::add_option(std::string, unsigned&, std::string);
template Option Command::add_option(std::string, std::uint64_t&, std::string);
template Option Command::add_option(std::string, double&, std::string);

Option Command::add_option_function(std::string names,
                                    const std::function<void(const std::string&)>& take,
                                    std::string about) {
  return Option(*app_->add_option_function<std::string>(std::move(names), take, std::move(about)));
}

Option Command::add_flag(std::string names, bool& value, std::string about) {
  return Option(*app_->add_flag(std::move(names), value, std::move(about)));
}

Option Command::get_option(const std::string& name) { return Option(*app_->get_option(name)); }

void Command::footer(std::string text) { app_->footer(std::move(text)); }

void Command::callback(std::function<void()> run) { app_->callback(std::move(run)); }

void Command::require_subcommand(std::size_t least, std::size_t most) {
  app_->require_subcommand(least, most);
}

void Command::fallthrough() { app_->fallthrough(); }

bool Command::has_subcommand() const { return !app_->get_subcommands().empty(); }

std::optional<std::string> Command::option_without_value() const {
  for (const CLI::Option* option : app_->get_options())
    for (const std::string& value : option->results())
      if (value.empty()) return option->get_name();
  return std::nullopt;
}

Program::Program(std::string name, std::string about)
    : app_(std::make_unique<CLI::App>(std::move(about), std::move(name))) {
  app_->failure_message([](const CLI::App* program, const CLI::Error& error) {
    return "plumb: " + usage_sentence(*program, error) + "\n";
  });
}

Program::~Program() = default;

Command Program::command() { return Command(*app_); }

void Program::add_version(const std::string& text) { app_->set_version_flag("--version", text); }

bool Program::parse(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
    return true;
  } catch (const CLI::ParseError& error) {
    return app_->exit(error) == 0;
  }
}

}  // namespace plumb::command
