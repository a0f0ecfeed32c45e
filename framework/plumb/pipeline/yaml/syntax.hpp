#pragma once
/// Where text stops being YAML: the line that is to blame, which the parser often notices only a
/// line later.

#include <optional>
#include <string>

#include "plumb/pipeline/yaml/origin.hpp"

namespace plumb::pipeline {

struct SyntaxFault {
  Origin origin;
  std::string sentence, hint;
};

/// `noticed` is where the parser stopped and `message` why; `open` is the innermost '{' or '[' that
/// was not closed by then, if any. The place is moved only where the text leaves no doubt.
SyntaxFault syntax_fault(const std::string& text, const Origin& noticed, const std::string& message,
                         const std::optional<Origin>& open);

}  // namespace plumb::pipeline
