#include "plumb/slam/types.hpp"

namespace plumb {
namespace {

/// Registers all of them when the library is loaded, so that stored values and manifests that name
/// them can be read whatever module is there.
template <class... T>
bool defined() {
  (type_of<T>(), ...);
  return true;
}
const bool all_defined =
    defined<Trajectory, Frame, FrameRange, Segment, Descriptor, Features, Edges, Matches,
            Registration, Constraints, Poses, GridMap, Metrics>();

}  // namespace
}  // namespace plumb
