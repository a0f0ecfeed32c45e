#include "simulate/names.hpp"

#include "plumb/pipeline/yaml/diagnostics.hpp"

namespace plumb::simulate {

std::string suggestion(const std::string& wrong, const std::vector<std::string>& known) {
  const std::string nearest = pipeline::nearest(wrong, known);
  return (nearest.empty() ? "" : "did you mean '" + nearest + "'? ") +
         ("known: " + pipeline::joined(known));
}

}  // namespace plumb::simulate
