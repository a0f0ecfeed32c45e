#include "simulate/names.hpp"

#include "plumb/pipeline/yaml/diagnostics.hpp"

namespace plumb::simulate {

std::string suggestion(const std::string& wrong, const std::vector<std::string>& known) {
  const std::string near = pipeline::nearest(wrong, known);
  return (near.empty() ? "" : "did you mean '" + near + "'? ") +
         "known: " + pipeline::joined(known);
}

}  // namespace plumb::simulate
