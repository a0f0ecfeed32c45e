#pragma once
/// The wires of a pipeline as text that draws itself: Mermaid (GitHub, editors) and DOT (Graphviz).

#include <string>

#include "plumb/pipeline/bind/plan.hpp"

namespace plumb {

/// Steps as boxes, types on the arrows, groups and repeats as frames; what a repeat carries is a
/// rounded box, reached from the next pass by a dashed arrow.
std::string mermaid_graph(const Plan& plan);
std::string dot_graph(const Plan& plan);

}  // namespace plumb
