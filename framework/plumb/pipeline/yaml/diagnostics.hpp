#pragma once
/// What is wrong with a pipeline: collected while it is read, told all at once.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/data/error.hpp"
#include "plumb/pipeline/yaml/origin.hpp"

namespace plumb {

/// One mistake, for people.
struct Diagnostic {
  Origin origin;
  std::string sentence;  ///< "step 'thin' (filter.voxel_grid): unknown parameter 'laef'."
  std::string excerpt;   ///< the source line and a caret; empty for command-line options
  std::string
      hint;  ///< "Did you mean 'leaf' [length, 0.01 m to 100 m]?  Known: leaf."; may be empty

  /// "file:line:col: sentence", the excerpt and the hint, each on lines of their own, as
  /// io::plain() shows them.
  std::string text() const;
};

/// A pipeline that does not hold together. `what()` is the text of the first diagnostics, as many
/// as anybody reads, in the order of the files and lines, and the number of the others.
class PipelineError : public Error {
 public:
  /// `open`: not all mistakes were looked for.
  explicit PipelineError(std::vector<Diagnostic> diagnostics, bool open = false);
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

namespace pipeline {

/// Collects mistakes and remembers the files' texts, to show the lines in question.
class Diagnostics {
 public:
  /// Makes the text of `file` known.
  void read(const std::string& file, std::string_view text);
  /// One mistake. The same one at the same place is kept once. Throws PipelineError when there are
  /// too many to go on: what is all wrong is no pipeline, and to look for every mistake in it could
  /// take for ever.
  void add(const Origin& origin, std::string sentence, std::string hint = "");
  bool empty() const { return list_.empty(); }
  /// Throws PipelineError if there is any. A value that does not serve in several places that refer
  /// to it is told once.
  void raise() const;

 private:
  std::string excerpt_at(const Origin& origin) const;
  std::vector<std::string> files_;  ///< in the order they were read
  std::map<std::string, std::string> texts_;
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
