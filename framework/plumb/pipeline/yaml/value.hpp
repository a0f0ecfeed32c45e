#pragma once
/// Values as people write them: `0.3 m`, `2 %`, `true`, `none`. Read strictly: nothing is cut off
/// and nothing is guessed.

#include <variant>

#include "plumb/pipeline/yaml/tree.hpp"
#include "plumb/plugin/description.hpp"

namespace plumb::pipeline {

/// Why a value is refused, and the cure.
struct Fault {
  std::string sentence;  ///< "'0.3' has no unit", without a full stop
  std::string hint;      ///< "Write one of m, cm, mm, km behind it, as in '0.3 m'."
};

/// A number and the unit behind it, null for none.
struct Measured {
  double si = 0;
  const Unit* unit = nullptr;
};

/// Reads "0.3 m", "2m", "20". Refuses nan, infinities, overflow, and anything but a known unit
/// behind the number.
std::variant<Measured, Fault> read_number(const std::string& text);

/// Reads what `parameter` takes, in SI and in range. `none` is a value where the parameter may be
/// left open. A path is made absolute: relative to its file, or to the working folder when it comes
/// from the command line.
std::variant<ParameterValue, Fault> read_value(const ParameterDescription& parameter,
                                               const Node& node);

/// The name in "$name", or nothing. A scalar in quotes is never a reference.
std::optional<std::string> reference_in(const Node& node);

/// What a scalar means as text: in it '$$' stands for '$', in quotes every '$' for itself. Nothing
/// when a '$' is left that stands for no text.
std::optional<std::string> text_in(const Node& node);
/// Text as it is written without quotes: every '$' twice.
std::string dollars_doubled(const std::string& text);
/// How a '$' that is text is written, for hints.
inline constexpr const char* how_to_write_a_dollar =
    "A '$' that is text is written '$$', or the text put into quotes in the file.";

/// "a length", "an angle", "one of huber, cauchy".
std::string expected(const ParameterDescription& parameter);

/// A value that was read for `from`, as one for `to`: an integer serves as a bare number, anything
/// else must be of the same kind and quantity, and in the range of `to`.
std::variant<ParameterValue, Fault> converted(const ParameterDescription& from,
                                              const ParameterValue& value,
                                              const ParameterDescription& to);

}  // namespace plumb::pipeline
