#include "plumb/slam/report/weakness.hpp"

#include <algorithm>
#include <cctype>
#include <map>

#include "plumb/data/counted.hpp"
#include "plumb/slam/report/made_metrics.hpp"

namespace plumb {
namespace {

constexpr std::size_t most_of_a_kind = 3, most_with_verdict = 4;

struct Tally {
  std::size_t weak = 0, all = 0;
  void add(const EdgeRecord& edge) {
    ++all;
    weak += edge.status == "no matches" || edge.status == "rejected";
  }
};

/// The verdict, or nothing. Loops are guesses, of which many may be wrong; consecutive segments do
/// overlap.
std::string verdict(const RunResult& result) {
  Tally consecutive, any;
  for (const MadeMetrics& made : metrics_of(result))
    for (const EdgeRecord& edge : made.metrics->edges) {
      any.add(edge);
      if (edge.kind == EdgeKind::sequential) consecutive.add(edge);
    }
  const Tally& tally = consecutive.all ? consecutive : any;
  if (2 * tally.weak <= tally.all) return "";
  return "most of the result is not held by the clouds: over all stages " +
         std::to_string(tally.weak) + " of " + std::to_string(tally.all) +
         (consecutive.all ? " edges between consecutive segments" : " edges") +
         " found no pairs or were rejected. Likely causes: the odometry or the clouds are not in "
         "metres; the poses belong to other "
         "frames; the clouds are in world coordinates and were taken for the sensor's; or segments "
         "are too short or too far apart "
         "to overlap";
}

}  // namespace

std::string kind_of_sentence(const std::string& sentence) {
  std::string kind;
  for (const char c : sentence)
    if (!std::isdigit(static_cast<unsigned char>(c))) kind += c;
  return kind;
}

std::vector<std::string> weaknesses(const RunResult& result, bool warnings) {
  std::vector<std::string> said;
  if (warnings) said = result.warnings;
  for (const MadeMetrics& made : metrics_of(result))
    for (const std::string& note : made.metrics->notes) said.push_back(made.path + ": " + note);

  std::map<std::string, std::size_t> count, shown;
  for (const std::string& sentence : said) ++count[kind_of_sentence(sentence)];
  const std::string first = verdict(result);
  const std::size_t of_a_kind = first.empty() ? most_of_a_kind : 1;
  std::vector<std::string> lines;
  for (const std::string& sentence : said) {
    const std::string kind = kind_of_sentence(sentence);
    if (++shown[kind] > of_a_kind) continue;
    const std::size_t more = shown[kind] == of_a_kind ? count[kind] - of_a_kind : 0;
    lines.push_back(sentence + (more ? " (and " + std::to_string(more) + " more like this)" : ""));
  }
  if (first.empty()) return lines;
  if (lines.size() > most_with_verdict) {
    const std::size_t left = lines.size() - most_with_verdict;
    lines.resize(most_with_verdict);
    lines.push_back("and " + counted(left, "more sentences of other kinds, not shown"));
  }
  lines.insert(lines.begin(), first);
  return lines;
}

}  // namespace plumb
