/// Outcomes as a plot: of the number that decides a row a variant, with its interval.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "plumb/slam/experiment/outcome.hpp"

namespace plumb::experiment {
namespace {

constexpr double scale_width = 620, right = 40, row_height = 26, top = 60;  // [px]
constexpr double character = 7.5;                                           // of names, about [px]

std::string escaped(const std::string& text) {
  std::string all;
  for (const char c : text) {
    if (c == '&')
      all += "&amp;";
    else if (c == '<')
      all += "&lt;";
    else if (c == '"')
      all += "&quot;";
    else
      all += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return all;
}

std::string pixels(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

/// From contrasts to pixels, right of the variants' names.
struct Range {
  double low = -0.01, high = 0.01;
  double names = 0;  ///< [px] width of the longest

  void hold(double value) { low = std::min(low, value), high = std::max(high, value); }
  double x(double value) const {
    const double margin = 0.05 * (high - low);
    return names + scale_width * (value - low + margin) / (high - low + 2 * margin);
  }
};

Range axis_of(const Judged& number, double margin) {
  Range axis;
  axis.hold(-margin), axis.hold(margin);
  for (const Contrast& c : number.contrasts) {
    axis.names = std::max(axis.names, 24 + character * static_cast<double>(c.variant.size()));
    for (const double one : c.by_input) axis.hold(one);
    if (c.interval) axis.hold(c.interval->low), axis.hold(c.interval->high);
  }
  return axis;
}

std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return "<line x1='" + pixels(x1) + "' y1='" + pixels(y1) + "' x2='" + pixels(x2) + "' y2='" +
         pixels(y2) + "' " + style + "/>\n";
}

std::string words(double x, double y, const std::string& text, const char* anchor) {
  return "<text x='" + pixels(x) + "' y='" + pixels(y) + "' text-anchor='" + anchor + "'>" +
         escaped(text) + "</text>\n";
}

/// Values at which the axis is marked, as contrasts: round ratios, or fifths of what is shown.
std::vector<double> marks_of(const Judged& number, const Range& axis) {
  std::vector<double> marks;
  if (number.scale == Scale::difference) {
    for (int k = 0; k <= 5; ++k) marks.push_back(axis.low + (axis.high - axis.low) * k / 5);
    return marks;
  }
  static constexpr std::array<double, 17> ratios = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 0.8, 0.9, 1,
                                                    1.1,  1.25, 1.5,  2,   5,   10,  20,  100};
  double last = -std::numeric_limits<double>::infinity();
  for (const double ratio : ratios) {
    const double at = std::log(ratio);
    constexpr double apart = 45;  // [px], so that words do not run together
    if (at < axis.low || at > axis.high || axis.x(at) - last < apart) continue;
    marks.push_back(at);
    last = axis.x(at);
  }
  return marks;
}

std::string mark_text(const Judged& number, double contrast) {
  char text[32];
  const double shown = number.scale == Scale::ratio ? std::exp(contrast) : contrast;
  std::snprintf(text, sizeof text, number.scale == Scale::ratio ? "x %.3g" : "%+.3g", shown);
  return text;
}

std::string row_of(const Contrast& c, const Range& axis, double y) {
  std::string text = words(axis.names - 12, y + 4, c.variant, "end");
  if (c.by_input.empty()) return text + words(axis.x(0) + 8, y + 4, "no result", "start");
  for (const double one : c.by_input)
    text += line(axis.x(one), y - 5, axis.x(one), y + 5, "stroke='#999'");
  if (c.interval)
    text += line(axis.x(c.interval->low), y, axis.x(c.interval->high), y,
                 "stroke='#1f5fa8' stroke-width='3'");
  return text + "<circle cx='" + pixels(axis.x(c.estimate)) + "' cy='" + pixels(y) +
         "' r='4.5' fill='#1f5fa8'><title>" + escaped(name_of(c.verdict)) + "</title></circle>\n";
}

}  // namespace

std::string outcome_svg(const Outcome& outcome) {
  const Judged* number = outcome.primary();
  const double margin =
      number && number->scale == Scale::ratio ? std::log1p(outcome.rules.margin) : 0;
  const Range axis = number ? axis_of(*number, margin) : Range();
  const std::size_t rows = number ? number->contrasts.size() : 0;
  const double bottom = top + row_height * static_cast<double>(rows);
  std::string text = "<svg xmlns='http://www.w3.org/2000/svg' width='" +
                     pixels(axis.names + scale_width + right) + "' height='" + pixels(bottom + 50) +
                     "' font-family='sans-serif' font-size='13'>\n"
                     "<rect width='100%' height='100%' fill='white'/>\n";
  if (!number) return text + words(20, 30, "nothing was compared", "start") + "</svg>\n";
  text += words(20, 24, number->name + " against " + reference_of(outcome), "start");
  text += words(20, 42,
                "dots: mean, bars: 95 %, ticks: inputs, band: equivalent; to the left is " +
                    std::string(number->higher_is_better ? "worse" : "better"),
                "start");
  text += "<rect x='" + pixels(axis.x(-margin)) + "' y='" + pixels(top) + "' width='" +
          pixels(axis.x(margin) - axis.x(-margin)) + "' height='" + pixels(bottom - top) +
          "' fill='#e4ecd8'/>\n";
  text += line(axis.x(0), top, axis.x(0), bottom, "stroke='black'");
  for (const double mark : marks_of(*number, axis)) {
    text += line(axis.x(mark), bottom, axis.x(mark), bottom + 5, "stroke='black'");
    text += words(axis.x(mark), bottom + 22, mark_text(*number, mark), "middle");
  }
  for (std::size_t k = 0; k < rows; ++k)
    text += row_of(number->contrasts[k], axis, top + row_height * (static_cast<double>(k) + 0.5));
  return text + "</svg>\n";
}

}  // namespace plumb::experiment
