#include "plumb/slam/experiment/measured.hpp"

#include <algorithm>

namespace plumb::experiment {

const Figure* Cell::find(const std::string& name) const {
  const auto at =
      std::ranges::find_if(figures, [&](const Figure& f) { return f.number.name == name; });
  return at == figures.end() ? nullptr : &*at;
}

Measured::Measured(std::vector<std::string> variant_names, std::vector<InputSize> input_sizes,
                   std::size_t replicate_count)
    : variants(std::move(variant_names)),
      inputs(std::move(input_sizes)),
      replicates(replicate_count),
      cells(variants.size() * inputs.size() * replicates) {}

Cell& Measured::at(std::size_t variant, std::size_t input, std::size_t replicate) {
  return cells[(variant * inputs.size() + input) * replicates + replicate];
}

const Cell& Measured::at(std::size_t variant, std::size_t input, std::size_t replicate) const {
  return cells[(variant * inputs.size() + input) * replicates + replicate];
}

std::size_t Measured::failures() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(cells, [](const Cell& cell) { return !cell.failure.empty(); }));
}

std::vector<Number> numbers_in(const Measured& measured) {
  std::vector<Number> numbers;
  for (const Cell& cell : measured.cells)
    for (const Figure& figure : cell.figures)
      if (std::ranges::none_of(
              numbers, [&](const Number& number) { return number.name == figure.number.name; }))
        numbers.push_back({figure.number.name, 0, figure.number.unit});
  return numbers;
}

std::string usual_primary(const std::vector<Number>& numbers) {
  const auto first = [&](const auto& holds) {
    const auto at = std::ranges::find_if(numbers, [&](const Number& n) { return holds(n.name); });
    return at == numbers.end() ? std::string() : at->name;
  };
  for (const char* begin : {"error.", "relation_error.", "map_error.", "match_rmse."}) {
    const std::string name = first([&](const std::string& n) {
      return n.starts_with(begin) && (n.ends_with(".ate") || std::string(begin) != "error.");
    });
    if (!name.empty()) return name;
  }
  return first([](const std::string&) { return true; });
}

}  // namespace plumb::experiment
