/// SLAM's types as stores and manifests see them: by their names and their code alone.
#include "plumb/slam/types.hpp"

#include <gmock/gmock.h>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/slam/cloud_testing.hpp"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

Segment segment_of(std::size_t points) {
  Segment segment;
  segment.range.end = 10;
  segment.range.T_segment_frame.resize(10);
  return segment.with(full_cloud(points), std::vector<std::uint16_t>(points, 9));
}

Registration some_registration() {
  Registration registration;
  registration.T_i_j.translation.x() = 2;
  registration.information(3, 4) = 0.5;
  registration.pairs = 7, registration.accepted = true;
  return registration;
}

TEST(SlamTypes, AreRegisteredWhenTheLibraryIsLoaded) {
  const std::pair<const char*, const char*> all[] = {
      {"Trajectory", ""},     {"Frame", "frame"},      {"FrameRange", "segment"},
      {"Segment", "segment"}, {"Features", "segment"}, {"Descriptor", "segment"},
      {"Edges", ""},          {"Matches", "edge"},     {"Registration", "edge"},
      {"Constraints", ""},    {"Poses", ""},           {"GridMap", ""},
      {"Metrics", ""}};
  for (const auto& [name, items] : all) {
    const Type* type = find_type(name);
    ASSERT_NE(type, nullptr) << name;
    ASSERT_NE(type->code, nullptr) << name;
    EXPECT_EQ(type->kind ? type->kind->name : "", items) << name;
    EXPECT_THAT(type->layout, HasSubstr("Eigen")) << name;
  }
}

TEST(SlamTypes, SayWhatSegmentsAreMadeOfAndWhatEdgesJoin) {
  FrameRange range;
  range.first = 3, range.end = 7;
  EXPECT_EQ(type_of<FrameRange>().name, find_kind("segment")->ranges);
  EXPECT_EQ(type_of<FrameRange>().code->range(&range), (std::pair<std::size_t, std::size_t>(3, 7)));
  Edges edges;
  edges.segments = 5, edges.list = {{0, 1}, {2, 4}};
  EXPECT_EQ(type_of<Edges>().name, find_kind("edge")->list);
  const ListCode& list = *type_of<Edges>().code->list;
  EXPECT_EQ(list.size(&edges), 2u);
  EXPECT_EQ(list.ends(&edges, 1), (std::pair<std::size_t, std::size_t>(2, 4)));
  EXPECT_EQ(list.ends_count(&edges), 5u);
}

template <class T>
std::string written(const T& value) {
  OutArchive<TextSink> out;
  type_of<T>().code->write(&value, out);
  return std::move(out.text);
}
template <class T>
void expect_read_back(const T& value) {
  const TypeCode& code = *type_of<T>().code;
  const std::string bytes = written(value);
  InArchive in(bytes);
  const auto back = code.read(in);
  EXPECT_TRUE(in.at_end()) << type_of<T>().name;
  EXPECT_EQ(code.hash(back.get()), code.hash(&value)) << type_of<T>().name;
  EXPECT_STREQ(code.fault(back.get()), "") << type_of<T>().name;
  EXPECT_EQ(written(*std::static_pointer_cast<const T>(back)), bytes) << type_of<T>().name;
}

TEST(SlamTypes, AreReadBackAsTheyWereWritten) {
  expect_read_back(segment_of(77));
  expect_read_back(Frame{5, full_cloud(3)});
  Edges edges;
  edges.segments = 3, edges.list = {{0, 1}, {1, 2, EdgeKind::loop, 0.5f, 4}};
  expect_read_back(edges);
  Matches matches;
  matches.p = {{1, 2, 3}, {4, 5, 6}}, matches.q = matches.p;
  matches.weight = {1, 0.5f}, matches.found = 9, matches.to_plane = true;
  expect_read_back(matches);
  expect_read_back(some_registration());
  Metrics metrics;
  metrics.add("rmse", 0.21, "m").notes = {"weak"};
  metrics.edges.resize(1);
  expect_read_back(metrics);
}

TEST(SlamTypes, LayTheColumnsOfACloudWhereTheyCanBeMapped) {
  const Segment segment = segment_of(77);
  const std::string bytes = written(segment);
  const auto place_of = [&](const auto& array) {
    return bytes.find(std::string_view(reinterpret_cast<const char*>(array.data()),
                                       array.size() * sizeof array[0]));
  };
  for (const auto* array :
       {&segment.cloud.x, &segment.cloud.y, &segment.cloud.intensity, &segment.cloud.nx}) {
    ASSERT_NE(place_of(*array), std::string::npos);
    EXPECT_EQ(place_of(*array) % 16, 0u);
  }
  EXPECT_EQ(place_of(segment.cloud.ring) % 16, 0u);
}

TEST(SlamTypes, CountTheSearchTreeThatMayBeBuiltOnACloud) {
  const auto bytes = [](std::size_t points) {
    const Segment segment = segment_of(points);
    return type_of<Segment>().code->bytes(&segment);
  };
  // Eight floats and two 16-bit numbers a point, and 24 bytes of the tree.
  EXPECT_EQ(bytes(200) - bytes(100), 100 * (8 * sizeof(float) + 2 * sizeof(std::uint16_t) + 24));
}

/// As of a module that was built with another Eigen or another instruction set.
TEST(SlamTypes, AreRefusedWhereAPoseLiesOtherwiseInMemory) {
  Type other = type_of<Poses>();
  other.layout = "24/8, Eigen 3.4.0, pose 64/32";
  EXPECT_THAT(
      io::refusal([&] { define_type(other); }),
      AllOf(StartsWith("type 'Poses' is defined twice, and not alike"),
            HasSubstr(type_of<Poses>().layout + " there"), HasSubstr(other.layout + " here")));
}

}  // namespace
}  // namespace plumb
