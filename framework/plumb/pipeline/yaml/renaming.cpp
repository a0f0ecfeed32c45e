#include "plumb/pipeline/yaml/renaming.hpp"

namespace plumb {
namespace {

constexpr const char* last_day = "goes with 0.3.0";
constexpr const char* set_option = "--set ";

/// "--set coarse.near.max=2m" with the path or the value of now.
std::string option_of_now(const Renaming& renaming) {
  std::string option = renaming.origin.file.substr(std::string(set_option).size());
  const auto equals = option.find('=');
  if (option.compare(0, equals, renaming.was) == 0)
    option.replace(0, equals, renaming.now);
  else if (const auto at = option.find(renaming.was, equals); at != option.npos)
    option.replace(at, renaming.was.size(), renaming.now);
  return set_option + option;
}

}  // namespace

std::string Renaming::warning() const {
  const std::string place = origin.text() + ": warning: ";
  if (kind == Kind::standard)
    return place + "'" + was + "' is not given and its default has changed; because of the old " +
           "names in this file it is read with the former one, " + now + ", which " + last_day +
           ". 'plumb migrate " + origin.file + "' writes it out.";
  const std::string called =
      place + "'" + was + "' is called '" + now + "' now; the old name " + last_day + ". ";
  return origin.line > 0 ? called + "'plumb migrate " + origin.file + "' rewrites the file."
                         : called + "Write " + option_of_now(*this) + ".";
}

std::string Renaming::done() const {
  return origin.text() + ": " +
         (kind == Kind::standard ? "'" + was + ": " + now + "', the former default, is written out"
                                 : "'" + was + "' is '" + now + "' now");
}

}  // namespace plumb
