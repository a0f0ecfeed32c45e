#include "plumb/plugin/left_out.hpp"

#include "../fuzz.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(left_out) {
  for (const auto& [step, why] : read_left_out(bytes, "left_out.txt"))
    fuzz::require(!step.empty() && !why.empty() && step.find(": ") == step.npos,
                  "a step that was left out has a name and a reason");
}
