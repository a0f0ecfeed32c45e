/// Outcomes for people: on a terminal, on a page.
#include <algorithm>
#include <cstdio>

#include "plumb/slam/experiment/outcome.hpp"

namespace plumb::experiment {
namespace {

using Row = std::vector<std::string>;

std::string title_of(const Judged& number) {
  return number.name + (number.unit.empty() ? "" : " [" + number.unit + "]");
}

/// Variants as columns, inputs as rows, their means below.
std::vector<Row> rows_of(const Outcome& outcome, const Judged& number) {
  const Measured& m = outcome.measured;
  std::vector<Row> rows{{""}};
  for (const std::string& variant : m.variants) rows[0].push_back(variant);
  for (std::size_t k = 0; k < m.inputs.size(); ++k) {
    Row row{m.inputs[k].name};
    for (std::size_t v = 0; v < m.variants.size(); ++v)
      row.push_back(cell_text(outcome, v, k, number));
    rows.push_back(std::move(row));
  }
  if (m.inputs.size() < 2) return rows;
  Row means{number.scale == Scale::ratio ? "geometric mean" : "mean"};
  for (std::size_t v = 0; v < m.variants.size(); ++v)
    means.push_back(mean_text(outcome, v, number));
  rows.push_back(std::move(means));
  return rows;
}

/// The first column to the left, the others to the right.
std::string aligned(const std::vector<Row>& rows, const std::string& margin) {
  std::vector<std::size_t> width(rows[0].size());
  for (const Row& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  std::string text;
  for (const Row& row : rows) {
    text += margin + row[0] + std::string(width[0] - row[0].size(), ' ');
    for (std::size_t c = 1; c < row.size(); ++c)
      text += "  " + std::string(width[c] - row[c].size(), ' ') + row[c];
    text += "\n";
  }
  return text;
}

/// The number that decides first.
std::vector<const Judged*> in_order(const Outcome& outcome) {
  std::vector<const Judged*> all;
  for (const Judged& number : outcome.numbers) all.push_back(&number);
  std::stable_partition(all.begin(), all.end(),
                        [](const Judged* number) { return number->primary; });
  return all;
}

/// On how many inputs a variant is lower, the same and higher.
std::string by_input_of(const Contrast& contrast) {
  const auto count = [&](const auto& holds) {
    return std::to_string(std::ranges::count_if(contrast.by_input, holds));
  };
  return count([](double c) { return c < 0; }) + " / " + count([](double c) { return c == 0; }) +
         " / " + count([](double c) { return c > 0; });
}

/// What would end a cell or begin markup is written so that it does not.
std::string cell(const std::string& text) {
  std::string all;
  for (const char c : text) {
    if (c == '|' || c == '\\' || c == '*' || c == '_' || c == '<' || c == '`') all += '\\';
    all += c == '\n' ? ' ' : c;
  }
  return all;
}

std::string markdown_of(const std::vector<Row>& rows) {
  std::string text;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    text += "|";
    for (const std::string& one : rows[n]) text += " " + cell(one) + " |";
    text += "\n";
    if (n > 0) continue;
    text += "|";
    for (std::size_t c = 0; c < rows[n].size(); ++c) text += c == 0 ? " --- |" : " ---: |";
    text += "\n";
  }
  return text;
}

std::string p_text(const Contrast& contrast) {
  if (!contrast.adjusted_p) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", *contrast.adjusted_p);
  return text;
}

std::vector<Row> verdicts_of(const Outcome& outcome, const Judged& number) {
  std::vector<Row> rows{{"variant", "difference (95 %)", "lower / same / higher", "p", "verdict"}};
  for (const Contrast& contrast : number.contrasts)
    rows.push_back({contrast.variant, effect(number, contrast, reference_of(outcome)),
                    by_input_of(contrast), p_text(contrast),
                    verdict_words(contrast, outcome.measured.inputs.size())});
  return rows;
}

}  // namespace

std::string outcome_table(const Outcome& outcome) {
  std::string text;
  for (const Judged* number : in_order(outcome)) {
    text += title_of(*number) + (number->primary ? ", which decides" : "") + "\n" +
            aligned(rows_of(outcome, *number), "  ");
    for (const Contrast& contrast : number->contrasts)
      text += "  " +
              sentence(*number, contrast, reference_of(outcome), outcome.measured.inputs.size()) +
              (contrast.adjusted_p ? ", p " + p_text(contrast) : "") + "\n";
    text += "\n";
  }
  for (const std::string& note : notes_of(outcome)) text += note + "\n";
  return text;
}

std::string outcome_markdown(const Outcome& outcome) {
  std::string text = "# " + cell(outcome.name) + "\n\n";
  if (!outcome.about.empty()) text += cell(outcome.about) + "\n\n";
  for (const Judged* number : in_order(outcome)) {
    text += "## " + cell(title_of(*number)) + (number->primary ? ", which decides" : "") + "\n\n" +
            markdown_of(rows_of(outcome, *number)) + "\n";
    if (!number->contrasts.empty()) text += markdown_of(verdicts_of(outcome, *number)) + "\n";
  }
  for (const std::string& note : notes_of(outcome)) text += "- " + cell(note) + "\n";
  return text;
}

}  // namespace plumb::experiment
