#include "plumb/engine/preflight.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "plumb/data/document.hpp"
#include "plumb/data/error.hpp"
#include "plumb/engine/record/output_folder.hpp"
#include "plumb/engine/record/quoted.hpp"
#include "plumb/pipeline/yaml/diagnostics.hpp"

namespace plumb {
namespace {

class Preflight {
 public:
  Preflight(const Plan& plan, const Registry& registry) : plan_(plan), registry_(registry) {}

  void run() {
    for (const PlannedStep& step : plan_.steps) {
      ask(step);
      look_at_file(step);
    }
    if (!found_.empty()) throw PipelineError(std::move(found_));
  }

 private:
  int passes(const PlannedStep& step) const {
    int most = 1;
    for (const PlannedParameter& parameter : step.parameters)
      if (parameter.row >= 0)
        most = std::max(
            most,
            static_cast<int>(plan_.repeats[parameter.repeat].rows[parameter.row].values.size()));
    return most;
  }

  /// Whether the parameters go together: what the step refuses, it refuses in the first pass that
  /// it would refuse in.
  void ask(const PlannedStep& step) {
    const Step& loaded = registry_.step(step.description->name);
    for (int pass = 0; pass < passes(step); ++pass) {
      ParameterValues values;
      for (std::size_t p = 0; p < step.parameters.size(); ++p) {
        const PlannedParameter& parameter = step.parameters[p];
        values[step.description->parameters[p].name] =
            parameter.row < 0 ? parameter.value
                              : plan_.repeats[parameter.repeat].value(parameter.row, pass);
      }
      try {
        loaded.parameters(values);
      } catch (const Error& e) {
        tell(step, step.origin, std::string(e.what()));
        return;
      }
    }
  }

  /// In all passes.
  std::vector<ParameterValue> values_of(const PlannedParameter& parameter) const {
    return parameter.row < 0 ? std::vector{parameter.value}
                             : plan_.repeats[parameter.repeat].rows[parameter.row].values;
  }

  void look_at_file(const PlannedStep& step) {
    const auto& outputs = step.description->outputs;
    if (std::none_of(outputs.begin(), outputs.end(),
                     [](const auto& port) { return port.type == &type_of<Document>(); }))
      return;
    for (std::size_t p = 0; p < step.parameters.size(); ++p) {
      if (step.description->parameters[p].name != "name") continue;
      const Origin& origin =
          step.parameters[p].origin.file.empty() ? step.origin : step.parameters[p].origin;
      for (const ParameterValue& value : values_of(step.parameters[p]))
        if (const auto* each = std::get_if<std::string>(&value))
          if (const std::string fault = fault_of_result_name(*each); !fault.empty())
            tell(step, origin, in_quotes(*each) + " " + fault);
      const auto* name = std::get_if<std::string>(&step.parameters[p].value);
      if (!name) continue;
      const auto [earlier, is_new] = written_.try_emplace(*name, step.path);
      if (!is_new)
        tell(step, origin,
             "step '" + earlier->second + "' writes '" + *name + "' too; give one another name");
    }
  }

  void tell(const PlannedStep& step, const Origin& origin, std::string sentence) {
    if (!sentence.ends_with('.')) sentence += '.';
    found_.push_back(
        {origin, "step '" + step.path + "' (" + step.description->name + "): " + sentence, "", ""});
  }

  const Plan& plan_;
  const Registry& registry_;
  std::map<std::string, std::string> written_;  ///< file name, step
  std::vector<Diagnostic> found_;
};

}  // namespace

void preflight(const Plan& plan, const Registry& registry) { Preflight(plan, registry).run(); }

}  // namespace plumb
