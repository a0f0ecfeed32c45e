#include "plumb/slam/types.hpp"

namespace plumb {

template const Type& type_of<Trajectory>();
template const Type& type_of<Frame>();
template const Type& type_of<FrameRange>();
template const Type& type_of<Segment>();
template const Type& type_of<Descriptor>();
template const Type& type_of<Features>();
template const Type& type_of<Edges>();
template const Type& type_of<Matches>();
template const Type& type_of<Registration>();
template const Type& type_of<Constraints>();
template const Type& type_of<Poses>();
template const Type& type_of<GridMap>();
template const Type& type_of<Metrics>();

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
