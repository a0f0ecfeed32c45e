#include "plumb/data/type.hpp"

#include <array>

#include "plumb/data/fault.hpp"
#include "plumb/data/registration.hpp"

namespace plumb {
namespace {

struct CountSink {
  std::size_t size = 0;
  void put(const void*, std::size_t n) { size += n; }
};

/// Search trees that may be built on a value [bytes]: 12 for the copy of a point, 12 for its place
/// in the tree.
template <class T>
std::size_t trees_of(const T&) {
  return 0;
}
std::size_t trees_of(const Segment& segment) { return segment.cloud.size() * 24; }

template <class T>
Type make(const char* name, int version, Grain grain) {
  return {name,
          version,
          grain,
          [](const void* value) { return content_hash(*static_cast<const T*>(value)); },
          [](const void* value, OutArchive<TextSink>& to) { to(*static_cast<const T*>(value)); },
          [](InArchive& from) -> std::shared_ptr<const void> {
            auto value = std::make_shared<T>();
            from(*value);
            return value;
          },
          [](const void* value) {
            OutArchive<CountSink> archive;
            archive(*static_cast<const T*>(value));
            return archive.size + trees_of(*static_cast<const T*>(value));
          },
          [](const void* value) { return fault_in(*static_cast<const T*>(value)); },
          []() -> std::shared_ptr<const void> { return std::make_shared<const T>(); }};
}

}  // namespace

const char* name_of(Grain grain) {
  switch (grain) {
    case Grain::whole:
      return "pipeline";
    case Grain::frame:
      return "frame";
    case Grain::segment:
      return "segment";
    case Grain::edge:
      return "edge";
  }
  return "?";
}

#define PLUMB_TYPE(T, VERSION, GRAIN)                            \
  template <>                                                    \
  const Type& type_of<T>() {                                     \
    static const Type type = make<T>(#T, VERSION, Grain::GRAIN); \
    return type;                                                 \
  }
PLUMB_TYPE(Trajectory, 1, whole)
PLUMB_TYPE(Frame, 1, frame)
PLUMB_TYPE(FrameRange, 1, segment)
PLUMB_TYPE(Segment, 1, segment)
PLUMB_TYPE(Descriptor, 1, segment)
PLUMB_TYPE(Features, 1, segment)
PLUMB_TYPE(Edges, 1, whole)
PLUMB_TYPE(Matches, 1, edge)
PLUMB_TYPE(Registration, 1, edge)
PLUMB_TYPE(Constraints, 1, whole)
PLUMB_TYPE(Poses, 1, whole)
PLUMB_TYPE(GridMap, 1, whole)
PLUMB_TYPE(Metrics, 1, whole)
PLUMB_TYPE(Document, 1, whole)
#undef PLUMB_TYPE

const Type* find_type(std::string_view name) {
  static const std::array<const Type*, 14> all = {
      &type_of<Trajectory>(),  &type_of<Frame>(),      &type_of<FrameRange>(),
      &type_of<Segment>(),     &type_of<Descriptor>(), &type_of<Features>(),
      &type_of<Edges>(),       &type_of<Matches>(),    &type_of<Registration>(),
      &type_of<Constraints>(), &type_of<Poses>(),      &type_of<GridMap>(),
      &type_of<Metrics>(),     &type_of<Document>()};
  for (const Type* type : all)
    if (name == type->name) return type;
  return nullptr;
}

}  // namespace plumb
