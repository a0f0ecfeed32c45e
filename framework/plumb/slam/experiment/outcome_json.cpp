/// Outcomes for programs, whole: written, and read back as a baseline.
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "plumb/data/error.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/slam/experiment/outcome.hpp"

namespace plumb::experiment {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t largest_outcome = std::uint64_t{1} << 30;  // [byte]
constexpr std::size_t most_cells = 100000;

const char* name_of(Method method) {
  switch (method) {
    case Method::none:
      return "none";
    case Method::identical:
      return "identical";
    case Method::sign_flip:
      return "sign-flip over inputs";
    case Method::segments:
      return "bootstrap over segments";
    case Method::replicates:
      return "bootstrap over replicates";
  }
  return "?";
}

Json json_of(const Replicates& replicates) {
  return {{"count", replicates.count},
          {"seed", replicates.seed},
          {"skip_frames", replicates.skip_frames},
          {"drop_frames", replicates.drop_frames},
          {"phase", replicates.phase},
          {"seeds", replicates.seeds}};
}

Json json_of(const Figure& figure) {
  Json json{
      {"name", figure.number.name}, {"value", figure.number.value}, {"unit", figure.number.unit}};
  if (figure.from_cache) json["cached"] = true;
  if (figure.segments.size() > 0)
    json["segments"] = {{"root", figure.segments.root},
                        {"sum", figure.segments.sum},
                        {"count", figure.segments.count}};
  return json;
}

Json json_of(const Measured& m) {
  Json cells = Json::array();
  for (std::size_t v = 0; v < m.variants.size(); ++v)
    for (std::size_t k = 0; k < m.inputs.size(); ++k)
      for (std::size_t r = 0; r < m.replicates; ++r) {
        const Cell& cell = m.at(v, k, r);
        Json json{{"variant", m.variants[v]}, {"input", m.inputs[k].name}, {"replicate", r + 1}};
        if (!cell.failure.empty()) json["failed"] = cell.failure;
        json["seconds"] = cell.seconds;
        json["made"] = cell.made;
        json["reused"] = cell.reused;
        json["numbers"] = Json::array();
        for (const Figure& figure : cell.figures) json["numbers"].push_back(json_of(figure));
        cells.push_back(std::move(json));
      }
  return cells;
}

/// On the scale of people: ratios, not logarithms.
double as_read(const Judged& number, double contrast) {
  return number.scale == Scale::ratio ? std::exp(contrast) : contrast;
}

Json json_of(const Judged& number, const Contrast& c, const Measured& m) {
  Json json{{"verdict", plumb::experiment::name_of(c.verdict)},
            {"on_these_data", c.on_these_data()}};
  if (!c.by_input.empty()) {
    json[number.scale == Scale::ratio ? "ratio" : "difference"] = as_read(number, c.estimate);
    if (c.interval)
      json["interval"] = {as_read(number, c.interval->low), as_read(number, c.interval->high)};
  }
  json["method"] = name_of(c.method);
  if (c.p) json["p"] = *c.p;
  if (c.adjusted_p) json["adjusted_p"] = *c.adjusted_p;
  json["smallest_p"] = c.least_p;
  if (c.least_shown) json["smallest_shown"] = as_read(number, *c.least_shown);
  json["failed_inputs"] = c.failed_inputs;
  json["inputs"] = Json::array();
  for (const std::size_t k : c.inputs) json["inputs"].push_back(m.inputs[k].name);
  json["by_input"] = Json::array();
  for (const double contrast : c.by_input) json["by_input"].push_back(as_read(number, contrast));
  return json;
}

/// A number with the values of each variant by input (null for none) and their mean; of the others
/// what they are `against` the reference.
Json json_of(const Judged& number, const Outcome& outcome) {
  const Measured& m = outcome.measured;
  Json json{{"name", number.name},
            {"unit", number.unit},
            {"scale", number.scale == Scale::ratio ? "ratio" : "difference"},
            {"exploratory", !number.primary},
            {"better", number.higher_is_better ? "higher" : "lower"}};
  json["variants"] = Json::object();
  for (std::size_t v = 0; v < m.variants.size(); ++v) {
    Json values = Json::array();
    std::vector<double> known;
    for (std::size_t k = 0; k < m.inputs.size(); ++k) {
      const Standing stands = standing(m, v, k, number);
      const bool serves = stands.value && !stands.from_cache;
      values.push_back(serves ? Json(*stands.value) : Json());
      if (serves) known.push_back(*stands.value);
    }
    const auto mean = mean_of(known, number.scale);
    Json of{{"values", std::move(values)}, {"mean", mean ? Json(*mean) : Json()}};
    for (const Contrast& contrast : number.contrasts)
      if (contrast.variant == m.variants[v]) of["against"] = json_of(number, contrast, m);
    json["variants"][m.variants[v]] = std::move(of);
  }
  return json;
}

/// A number that is not negative, has no fraction and fits into T. Throws Error.
template <class T>
T whole(const Json& json) {
  const auto number = json.is_number_unsigned() ? json.get<std::uint64_t>() : 0;
  if (!json.is_number_unsigned() || !std::in_range<T>(number))
    throw Error("it has " + json.dump().substr(0, 40) + " where a count or a seed belongs");
  return static_cast<T>(number);
}

Replicates replicates_of(const Json& json) {
  Replicates replicates;
  replicates.count = whole<std::size_t>(json.at("count"));
  replicates.seed = whole<std::uint64_t>(json.at("seed"));
  replicates.skip_frames = whole<std::uint32_t>(json.at("skip_frames"));
  replicates.drop_frames = json.at("drop_frames").get<double>();
  replicates.phase = json.at("phase").get<bool>();
  replicates.seeds = json.at("seeds").get<bool>();
  return replicates;
}

Figure figure_of(const Json& json) {
  Figure figure;
  figure.number = {json.at("name").get<std::string>(), json.at("value").get<double>(),
                   json.at("unit").get<std::string>()};
  figure.from_cache = json.value("cached", false);
  if (!json.contains("segments")) return figure;
  const Json& segments = json.at("segments");
  figure.segments.root = segments.at("root").get<bool>();
  figure.segments.sum = segments.at("sum").get<std::vector<double>>();
  figure.segments.count = segments.at("count").get<std::vector<double>>();
  if (figure.segments.sum.size() != figure.segments.count.size())
    throw Error("a number's sums and counts by segment are not equally many");
  return figure;
}

std::size_t place_of(const std::string& name, const std::vector<std::string>& names) {
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == name) return k;
  throw Error("'" + name + "' is not one of its variants and inputs");
}

Measured measured_of(const Json& json, std::size_t replicates) {
  const auto variants = json.at("variants").get<std::vector<std::string>>();
  std::vector<InputSize> inputs;
  std::vector<std::string> names = json.at("inputs").get<std::vector<std::string>>();
  for (std::size_t k = 0; k < names.size(); ++k)
    inputs.push_back({names[k], whole<std::size_t>(json.at("input_files").at(k)),
                      whole<std::uint64_t>(json.at("input_bytes").at(k))});
  if (replicates < 1 || replicates > most_cells || variants.size() > most_cells ||
      names.size() > most_cells || variants.size() * names.size() > most_cells / replicates)
    throw Error("it has more runs than anybody makes");
  Measured measured(variants, inputs, replicates);
  for (const Json& run : json.at("runs")) {
    const auto r = whole<std::size_t>(run.at("replicate"));
    if (r < 1 || r > replicates) throw Error("a run's replicate is none of those that it has");
    Cell& cell = measured.at(place_of(run.at("variant").get<std::string>(), variants),
                             place_of(run.at("input").get<std::string>(), names), r - 1);
    cell.failure = run.value("failed", "");
    for (const Json& number : run.at("numbers")) cell.figures.push_back(figure_of(number));
  }
  return measured;
}

}  // namespace

std::string outcome_json(const Outcome& outcome) {
  const Measured& m = outcome.measured;
  Json json{{"experiment", outcome.name}, {"about", outcome.about}, {"variants", m.variants}};
  for (const char* key : {"inputs", "input_files", "input_bytes"}) json[key] = Json::array();
  for (const InputSize& input : m.inputs) {
    json["inputs"].push_back(input.name);
    json["input_files"].push_back(input.files);
    json["input_bytes"].push_back(input.bytes);
  }
  json["replicates"] = json_of(outcome.replicates);
  json["primary"] = outcome.rules.primary;
  json["margin"] = outcome.rules.margin;
  json["reference"] = reference_of(outcome);
  json["bootstrap"] = {{"draws", outcome.rules.draws}, {"seed", outcome.rules.seed}};
  json["swept"] = Json::object();
  for (std::size_t v = 0; v < outcome.swept.size() && v < m.variants.size(); ++v)
    for (const auto& [name, value] : outcome.swept[v]) json["swept"][m.variants[v]][name] = value;
  json["numbers"] = Json::array();
  for (const Judged& number : outcome.numbers) json["numbers"].push_back(json_of(number, outcome));
  json["runs"] = json_of(m);
  return json.dump(-1, ' ', true, Json::error_handler_t::replace);  // names may hold any bytes
}

Outcome outcome_of_json(const std::filesystem::path& file) {
  const io::FileBytes bytes(file, largest_outcome, "outcome");
  try {
    const Json json = Json::parse(bytes.view().begin(), bytes.view().end());
    Outcome outcome;
    outcome.name = json.at("experiment").get<std::string>();
    outcome.replicates = replicates_of(json.at("replicates"));
    outcome.rules.primary = json.at("primary").get<std::string>();
    outcome.rules.margin = json.at("margin").get<double>();
    outcome.measured = measured_of(json, outcome.replicates.count);
    return outcome;
  } catch (const Json::exception&) {
    io::refuse(file,
               "is not what plumb compare writes as JSON; give a file that `plumb compare ... "
               "--save FILE.json` wrote");
  } catch (const Error& e) {
    io::refuse(file, std::string(e.what()) +
                         "; it was changed: write it again with `plumb compare "
                         "... --save FILE.json`");
  }
}

}  // namespace plumb::experiment
