#pragma once
/// What is wrong with a pipeline: collected while it is read, told all at once.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/data/error.hpp"
#include "plumb/pipeline/plan.hpp"

namespace plumb {

/// One mistake, for people.
struct Diagnostic {
  Origin origin;
  std::string sentence;  ///< "step 'thin' (filter.voxel_grid): unknown parameter 'laef'."
  std::string excerpt;   ///< the source line and a caret; empty for command-line options
  std::string
      hint;  ///< "Did you mean 'leaf' [length, 0.01 m to 100 m]?  Known: leaf."; may be empty

  /// "file:line:col: sentence", the excerpt and the hint, each on lines of their own.
  std::string text() const;
};

/// A pipeline that does not hold together. `what()` is the text of every diagnostic, in the order
/// of the files and lines.
class PipelineError : public Error {
 public:
  explicit PipelineError(std::vector<Diagnostic> diagnostics);
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

namespace pipeline {

/// Collects mistakes and remembers the files' texts, to show the lines in question.
class Diagnostics {
 public:
  /// Makes the lines of `file` known.
  void read(const std::string& file, std::string_view text);
  /// One mistake. The same one at the same place is kept once.
  void add(const Origin& origin, std::string sentence, std::string hint = "");
  bool empty() const { return list_.empty(); }
  /// Throws PipelineError if there is any.
  void raise() const;

 private:
  std::vector<std::string> files_;  ///< in the order they were read
  std::map<std::string, std::vector<std::string>> lines_;
  std::vector<Diagnostic> list_;
};

/// The known name nearest to `name` by edit distance (a swap of neighbours counts one); empty when
/// none is near.
std::string nearest(std::string_view name, const std::vector<std::string>& known);

/// "Did you mean 'leaf'?  Known: leaf, cap." The second part only while the list is short enough to
/// read.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

/// "a, b, c".
std::string joined(const std::vector<std::string>& words, const char* between = ", ");

}  // namespace pipeline
}  // namespace plumb
