#include "plumb/pipeline/print/graph.hpp"

#include <functional>
#include <map>

namespace plumb {
namespace {

/// A group, a repeat, or the pipeline itself, with what lies directly in it.
struct Box {
  std::string label;
  int repeat = -1;
  std::vector<int> steps;
  std::map<std::string, Box> inner;  // by name
};

Box& frame_of(Box& root, const std::string& path) {
  Box* at = &root;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string name = path.substr(begin, end - begin);
    at = &at->inner[name];
    if (at->label.empty()) at->label = name;
    begin = end + 1;
  }
  return *at;
}

Box frames_of(const Plan& plan) {
  Box root;
  for (std::size_t k = 0; k < plan.repeats.size(); ++k) {
    const PlannedRepeat& repeat = plan.repeats[k];
    Box& frame = frame_of(root, repeat.path);
    frame.repeat = static_cast<int>(k);
    frame.label += ": " + repeat.passes_text();
  }
  for (std::size_t k = 0; k < plan.steps.size(); ++k) {
    const std::string& path = plan.steps[k].path;
    const auto dot = path.rfind('.');
    frame_of(root, dot == std::string::npos ? "" : path.substr(0, dot))
        .steps.push_back(static_cast<int>(k));
  }
  return root;
}

std::string node_of(const Wire& wire) {
  return wire.step >= 0 ? "s" + std::to_string(wire.step)
                        : "r" + std::to_string(wire.repeat) + "c" + std::to_string(wire.carry);
}

std::string name_of_step(const PlannedStep& step) {
  return step.path.substr(step.path.rfind('.') + 1);
}

/// The type on a wire: of the output, or of what is carried.
const std::string& type_on(const Plan& plan, const Wire& wire) {
  const Wire* at = &wire;
  while (at->step < 0) at = &plan.repeats[at->repeat].carries[at->carry].next;
  return plan.steps[at->step].description->outputs[at->output].type->name;
}

/// How one notation writes the parts of a drawing.
struct Notation {
  std::string begin, end;
  std::function<std::string(const std::string& id, const std::string& name, const std::string& use)>
      step;
  std::function<std::string(const std::string& id, const std::string& name)> carry;
  std::function<std::string(const std::string& id, const std::string& label)> frame;
  std::string frame_end;
  std::function<std::string(const std::string& from, const std::string& to,
                            const std::string& label, bool dashed)>
      arrow;
};

void write_frame(const Plan& plan, const Box& frame, const Notation& notation,
                 const std::string& indent, int& frames, std::string& text) {
  if (frame.repeat >= 0) {
    const auto& carries = plan.repeats[frame.repeat].carries;
    for (std::size_t c = 0; c < carries.size(); ++c)
      text += indent +
              notation.carry("r" + std::to_string(frame.repeat) + "c" + std::to_string(c),
                             carries[c].name) +
              "\n";
  }
  for (const int step : frame.steps)
    text += indent +
            notation.step("s" + std::to_string(step), name_of_step(plan.steps[step]),
                          plan.steps[step].description->name) +
            "\n";
  for (const auto& [name, inner] : frame.inner) {
    text += indent + notation.frame("g" + std::to_string(frames++), inner.label) + "\n";
    write_frame(plan, inner, notation, indent + "  ", frames, text);
    text += indent + notation.frame_end + "\n";
  }
}

std::string drawn(const Plan& plan, const Notation& notation) {
  std::string text = notation.begin;
  int frames = 0;
  write_frame(plan, frames_of(plan), notation, "  ", frames, text);
  for (std::size_t k = 0; k < plan.steps.size(); ++k)
    for (const auto& wires : plan.steps[k].inputs)
      for (const Wire& wire : wires)
        text += "  " +
                notation.arrow(node_of(wire), "s" + std::to_string(k), type_on(plan, wire), false) +
                "\n";
  for (std::size_t r = 0; r < plan.repeats.size(); ++r)
    for (std::size_t c = 0; c < plan.repeats[r].carries.size(); ++c) {
      const PlannedCarry& carry = plan.repeats[r].carries[c];
      const std::string id = "r" + std::to_string(r) + "c" + std::to_string(c);
      text +=
          "  " + notation.arrow(node_of(carry.start), id, type_on(plan, carry.start), false) + "\n";
      text += "  " + notation.arrow(node_of(carry.next), id, "next pass", true) + "\n";
    }
  return text + notation.end;
}

}  // namespace

std::string mermaid_graph(const Plan& plan) {
  Notation notation;
  notation.begin = "flowchart TD\n";
  notation.step = [](const auto& id, const auto& name, const auto& use) {
    return id + "[\"" + name + "<br/>" + use + "\"]";
  };
  notation.carry = [](const auto& id, const auto& name) { return id + "([\"" + name + "\"])"; };
  notation.frame = [](const auto& id, const auto& label) {
    return "subgraph " + id + "[\"" + label + "\"]";
  };
  notation.frame_end = "end";
  notation.arrow = [](const auto& from, const auto& to, const auto& label, bool dashed) {
    return from + (dashed ? " -.->|" : " -->|") + label + "| " + to;
  };
  return drawn(plan, notation);
}

std::string dot_graph(const Plan& plan) {
  Notation notation;
  std::string name;
  for (const char c : plan.name)
    name += c == '"' || c == '\\' || static_cast<unsigned char>(c) < 0x20 ? '_' : c;
  notation.begin = "digraph \"" + name +
                   "\" {\n  node [shape=box, style=rounded, fontname=\"sans-serif\"];\n  edge "
                   "[fontname=\"sans-serif\", fontsize=10];\n";
  notation.end = "}\n";
  notation.step = [](const auto& id, const auto& step, const auto& use) {
    return id + " [label=\"" + step + "\\n" + use + "\"];";
  };
  notation.carry = [](const auto& id, const auto& carry) {
    return id + " [label=\"" + carry + "\", shape=oval];";
  };
  notation.frame = [](const auto& id, const auto& label) {
    return "subgraph cluster_" + id + " { label=\"" + label + "\";";
  };
  notation.frame_end = "}";
  notation.arrow = [](const auto& from, const auto& to, const auto& label, bool dashed) {
    return from + " -> " + to + " [label=\"" + label + "\"" +
           (dashed ? ", style=dashed, constraint=false" : "") + "];";
  };
  return drawn(plan, notation);
}

}  // namespace plumb
