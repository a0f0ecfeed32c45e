#pragma once
/// Texts in YAML's double quotes, byte for byte.

#include <optional>
#include <string>

namespace plumb {

/// With quotes; control characters become \xNN.
std::string in_quotes(const std::string& text);
/// As it is, when YAML reads it as this text.
std::string in_quotes_where_needed(const std::string& text);
/// What in_quotes() was given; nothing for anything else.
std::optional<std::string> from_quotes(const std::string& text);

}  // namespace plumb
