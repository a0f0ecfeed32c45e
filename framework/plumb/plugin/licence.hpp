#pragma once
/// The licences that whoever loads a module accepts, as its manifest states them.

#include <string>

namespace plumb {

/// Of a module's own code and of all libraries that it loads beside libplumb and what that loads.
struct Licence {
  std::string expression;  ///< SPDX: "BSD-3-Clause AND GPL-2.0-or-later"; empty: not stated
  std::string reason;      ///< a sentence: which library brings what; may be empty

  /// The expression, or "not stated".
  std::string text() const { return expression.empty() ? "not stated" : expression; }
};

/// "" for an SPDX expression of licences that are known here, or a sentence: what is wrong with it.
std::string fault_of_licence(const std::string& expression);

}  // namespace plumb
