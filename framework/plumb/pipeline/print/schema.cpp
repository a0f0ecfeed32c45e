#include "plumb/pipeline/print/schema.hpp"

#include <cmath>

#include "plumb/pipeline/print/schema_step.hpp"

namespace plumb {
namespace {

using pipeline::Json;
using pipeline::reference_pattern;

const char* name_pattern = "^[A-Za-z][A-Za-z0-9_]*$";
const char* path_pattern = "^[A-Za-z][A-Za-z0-9_]*(\\.[A-Za-z][A-Za-z0-9_]*)*$";

Json ref(const char* definition) { return {{"$ref", std::string("#/definitions/") + definition}}; }

/// An object with these properties and no others.
Json object(Json properties, Json required = Json::array()) {
  Json schema = {
      {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = std::move(required);
  return schema;
}

/// An object with free names and one kind of value.
Json map_of(Json value, const char* names) {
  return {{"type", "object"},
          {"propertyNames", {{"pattern", names}}},
          {"additionalProperties", std::move(value)}};
}

Json described(Json schema, const char* text) {
  schema["description"] = text;
  return schema;
}

Json scalar() { return {{"type", {"string", "number", "boolean"}}}; }
Json scalar_or_row() {
  return {{"type", {"string", "number", "boolean", "array"}}, {"items", scalar()}, {"minItems", 1}};
}
Json count(const char* text) {
  return {{"type", {"integer", "string"}},
          {"minimum", 1},
          {"maximum", 1000},
          {"pattern", "^" + std::string(reference_pattern) + "$"},
          {"description", text}};
}

/// A parameter of the pipeline: the type says what its default looks like.
Json parameter() {
  struct Kind {
    const char* name;
    ParameterKind kind;
    Quantity quantity;
  };
  std::vector<Kind> kinds = {{"path", ParameterKind::path, Quantity::none},
                             {"number", ParameterKind::number, Quantity::none},
                             {"integer", ParameterKind::integer, Quantity::none},
                             {"boolean", ParameterKind::boolean, Quantity::none},
                             {"text", ParameterKind::text, Quantity::none},
                             {"choice", ParameterKind::choice, Quantity::none}};
  for (const Quantity quantity :
       {Quantity::length, Quantity::angle, Quantity::time, Quantity::ratio, Quantity::speed,
        Quantity::angular_speed, Quantity::curvature, Quantity::frequency})
    kinds.push_back({name_of(quantity), ParameterKind::number, quantity});
  Json names = Json::array(), rules = Json::array();
  for (const Kind& kind : kinds) {
    names.push_back(kind.name);
    Json rule;
    rule["if"] = {{"properties", {{"type", {{"const", kind.name}}}}}, {"required", {"type"}}};
    if (kind.kind == ParameterKind::choice) {
      rule["then"] = {{"required", {"of"}}};
    } else {
      ParameterDescription type;
      type.kind = kind.kind;
      type.quantity = kind.quantity;
      type.may_be_none = true;
      type.low = -INFINITY;
      type.high = INFINITY;
      rule["then"] = {
          {"properties", {{"default", pipeline::schema_of_value(type)}, {"of", false}}}};
    }
    rules.push_back(rule);
  }
  Json schema = object(
      {{"type", {{"enum", names}}},
       {"of", described({{"type", "array"}, {"items", {{"type", "string"}}}, {"minItems", 1}},
                        "The values of a choice.")},
       {"default", described(scalar(), "Without it, a value must be given by a preset or --set.")},
       {"about", {{"type", "string"}}}},
      {"type"});
  schema["allOf"] = rules;
  return schema;
}

Json step(const Registry& registry) {
  Json names = Json::array(), rules = Json::array(), summaries = Json::array();
  for (const StepDescription* description : registry.all()) {
    names.push_back(description->name);
    summaries.push_back(description->summary);
    Json rule;
    rule["if"] = {{"properties", {{"use", {{"const", description->name}}}}}, {"required", {"use"}}};
    rule["then"] = pipeline::schema_of_step(*description);
    rules.push_back(rule);
  }
  Json schema =
      object({{"use", {{"type", "string"}, {"enum", names}, {"enumDescriptions", summaries}}},
              {"from", described({{"type", {"string", "array", "object"}}},
                                 "A step for the one input that fits, or steps by input.")},
              {"with", described({{"type", "object"}}, "Parameters.")},
              {"on_error", described({{"enum", {"stop", "drop"}}},
                                     "When a call fails: stop (the default), or drop, which leaves "
                                     "the edge without matches.")}},
             {"use"});
  if (!rules.empty()) schema["allOf"] = rules;
  return schema;
}

Json repeat() {
  ParameterDescription share;
  share.quantity = Quantity::ratio;
  share.low = 0;
  Json condition = object(
      {{"metric", described({{"type", "string"}, {"pattern", path_pattern}},
                            "A step of the body that gives Metrics, or one of its numbers.")},
       {"falls_by_less_than", pipeline::schema_of_value(share)},
       {"below", described({{"type", {"number", "string"}}}, "In the number's own unit.")}},
      {"metric"});
  condition["minProperties"] = 2;
  condition["maxProperties"] = 2;
  const Json conditions = {{"type", "array"}, {"items", condition}, {"minItems", 1}};
  Json until = object({{"all", conditions}, {"any", conditions}});
  until["minProperties"] = 1;
  until["maxProperties"] = 1;
  const Json reference = {{"type", "string"}, {"pattern", path_pattern}};
  const Json exhausted = {
      {"anyOf",
       {{{"enum", {"warn", "fail", "accept"}}},
        {{"type", "string"}, {"pattern", "^" + std::string(reference_pattern) + "$"}}}}};
  return object(
      {{"repeat",
        object(
            {{"passes", described(map_of(scalar_or_row(), name_pattern),
                                  "Rows: one value a pass, equally long, or one value for all.")},
             {"carry", described(map_of(reference, name_pattern),
                                 "What a step of one pass is called in the next.")},
             {"until", described(until, "When the passes may end before they are used up.")},
             {"at_least", count("Passes before 'until' is asked.")},
             {"at_most", count("Passes; when the rows are used up, their last column repeats.")},
             {"if_exhausted", described(exhausted, "What to do when 'until' never held.")}})},
       {"start",
        described(map_of(reference, name_pattern), "What is carried into the first pass.")},
       {"steps", ref("steps")}},
      {"repeat", "steps"});
}

Json pipeline_definition() {
  return object({{"plumb", {{"const", 1}}},
                 {"name", {{"type", "string"}}},
                 {"about", {{"type", "string"}}},
                 {"parameters", map_of(ref("parameter"), name_pattern)},
                 {"steps", ref("steps")}},
                {"plumb", "steps"});
}

/// What an overlay changes, beside `more` keys of its own.
Json edits(const Json& more, const Json& required) {
  Json properties = {
      {"name", {{"type", "string"}}},
      {"about", {{"type", "string"}}},
      {"remove",
       described({{"type", "array"}, {"items", {{"type", "string"}, {"pattern", path_pattern}}}},
                 "Steps to drop, by path.")},
      {"replace", described(map_of(ref("item"), path_pattern), "Steps by path, as in GROUP.STEP.")},
      {"add", described(map_of(ref("item"), path_pattern), "New steps by path.")},
      {"set",
       described(map_of(scalar_or_row(), path_pattern),
                 "Parameters, rows (GROUP.ROW) and parameters of steps (GROUP.STEP.PARAMETER).")}};
  properties.update(more);
  return object(properties, required);
}

Json overlay_definition() {
  return edits(
      {{"plumb", {{"const", 1}}},
       {"extends", described({{"type", "string"}},
                             "The pipeline that this one changes, relative to this file.")},
       {"also", described({{"type", "object"}, {"additionalProperties", ref("edits")}},
                          "Edits for further pipelines, by their paths relative to this file: as a "
                          "preset it serves them too.")}},
      {"plumb", "extends"});
}

}  // namespace

std::string pipeline_schema(const Registry& registry) {
  Json schema;
  schema["$schema"] = "http://json-schema.org/draft-07/schema#";
  schema["title"] = "Plumb pipeline";
  schema["type"] = "object";
  schema["if"] = {{"required", {"extends"}}};
  schema["then"] = ref("overlay");
  schema["else"] = ref("pipeline");
  Json& definitions = schema["definitions"];
  definitions["pipeline"] = pipeline_definition();
  definitions["overlay"] = overlay_definition();
  definitions["edits"] = edits(Json::object(), Json::array());
  definitions["parameter"] = parameter();
  definitions["steps"] = map_of(ref("item"), name_pattern);
  definitions["steps"]["minProperties"] = 1;
  // A step, a group or a repeat: by the key that only it has.
  definitions["item"] = {
      {"type", "object"},
      {"if", {{"required", {"repeat"}}}},
      {"then", ref("repeat")},
      {"else", {{"if", {{"required", {"steps"}}}}, {"then", ref("group")}, {"else", ref("step")}}}};
  definitions["group"] = object({{"steps", ref("steps")}}, {"steps"});
  definitions["repeat"] = repeat();
  definitions["step"] = step(registry);
  return schema.dump(2) + "\n";
}

}  // namespace plumb
