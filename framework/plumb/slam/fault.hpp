#pragma once
/// What no value on a wire may hold: non-finite numbers where a place or a direction is
/// meant, columns of other lengths than the others, places that lie beyond what they point into.
/// Asked of all that a step gives, so that the step that made it is named and not the one that
/// stumbles over it, and of all that is read from a store, whose files anyone may have written.

#include "plumb/slam/registration.hpp"

namespace plumb {

/// "" or what is wrong with a value, whatever step made it: "a pose with a number that is not
/// finite". The numbers of Metrics may be anything (there are errors of no pairs).
const char* fault_in(const Trajectory& trajectory);
const char* fault_in(const Frame& frame);
const char* fault_in(const FrameRange& range);
const char* fault_in(const Segment& segment);
const char* fault_in(const Descriptor& descriptor);
const char* fault_in(const Features& features);
const char* fault_in(const Edges& edges);
const char* fault_in(const Matches& matches);
const char* fault_in(const Registration& registration);
const char* fault_in(const Constraints& constraints);
const char* fault_in(const Poses& poses);
const char* fault_in(const GridMap& map);
const char* fault_in(const Metrics& metrics);

}  // namespace plumb
