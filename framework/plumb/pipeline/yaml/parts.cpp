#include "plumb/pipeline/yaml/parts.hpp"

namespace plumb::pipeline {

std::vector<std::string> parts_of(const std::string& text, char between) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == between)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

}  // namespace plumb::pipeline
