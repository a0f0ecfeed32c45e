#include "g2o_file.hpp"

#include <gmock/gmock.h>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb::source_g2o {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

struct G2oFile : testing::Test {
  io::TestFolder folder;
  fs::path path = folder.path() / "graph.g2o";

  G2oGraph read(const std::string& text) const { return read_g2o(folder.write("graph.g2o", text)); }
  std::string refusal(const std::string& text) const {
    return io::refusal([&] { read(text); });
  }
};

const std::string identity_triangle = " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n";

TEST_F(G2oFile, KeepsVerticesInOrderOfTheirNumbersAndEdgesByIndex) {
  const auto graph = read(
      "# a graph\n"
      "EDGE_SE3:QUAT 1000 7 1 2 3 0 0 0 2" +
      identity_triangle +
      "VERTEX_SE3:QUAT 1000 4 5 6 0 0 0.70710678118654752 0.70710678118654752 \r\n"
      "\nVERTEX_SE3:QUAT 7 0 0 1 0 0 0 -1\n");
  EXPECT_FALSE(graph.constraints.planar);
  EXPECT_THAT(graph.constraints.ids, ElementsAre(7, 1000));
  ASSERT_EQ(graph.poses.size(), 2u);
  EXPECT_EQ(graph.poses.T_world_segment[1].translation, Eigen::Vector3d(4, 5, 6));
  EXPECT_NEAR(angle(graph.poses.T_world_segment[1]), M_PI / 2, 1e-12);
  ASSERT_EQ(graph.constraints.relative.size(), 1u);
  const RelativePose& edge = graph.constraints.relative[0];
  EXPECT_EQ(edge.i, 1u);
  EXPECT_EQ(edge.j, 0u);
  EXPECT_EQ(edge.T_i_j.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(edge.T_i_j.rotation.norm(), 1, 1e-15);
  EXPECT_EQ(edge.information, Matrix6d::Identity());
}

TEST_F(G2oFile, FillsTheInformationFromItsUpperTriangle) {
  const auto graph = read(
      "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n"
      "EDGE_SE3:QUAT 0 1 0 0 0 0 0 0 1 11 12 13 14 15 16 22 23 24 25 26 33 34 35 36 44 45 46 55 56 "
      "66\n");
  const Matrix6d& m = graph.constraints.relative[0].information;
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < 6; ++b) EXPECT_EQ(m(a, b), 10 * (std::min(a, b) + 1) + std::max(a, b) + 1);
}

/// g2o's error of an EDGE_SE2, (x, y, angle), against ours of (t, q.vec).
TEST_F(G2oFile, GivesAPlanarEdgeTheSameCostForSmallErrors) {
  const auto graph = read(
      "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 2 1 1.5707963267948966\n"
      "EDGE_SE2 0 1 2 1 1.5707963267948966 10 1 2 20 3 30\n");
  EXPECT_TRUE(graph.constraints.planar);
  const RelativePose& edge = graph.constraints.relative[0];
  EXPECT_LT((edge.T_i_j * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(2, 2, 0)).norm(), 1e-12);
  Eigen::Matrix3d information;
  information << 10, 1, 2, 1, 20, 3, 2, 3, 30;
  const Eigen::Vector3d theirs(1e-3, -2e-3, 1.5e-3);
  Vector6d ours = Vector6d::Zero();
  ours.head<2>() = theirs.head<2>();
  ours.tail<3>() = exp_rotation({0, 0, theirs[2]}).vec();
  EXPECT_NEAR(ours.dot(edge.information * ours), theirs.dot(information * theirs), 1e-10);
  EXPECT_EQ(edge.information(2, 2), 0);
  EXPECT_EQ(edge.information(3, 3), 0);
}

TEST_F(G2oFile, HoldsFixedVerticesWhereTheyAre) {
  const auto graph = read("FIX 5 6\nVERTEX_SE2 5 1 2 3\nVERTEX_SE2 6 4 5 6\n");
  ASSERT_EQ(graph.constraints.absolute.size(), 2u);
  EXPECT_EQ(graph.constraints.absolute[1].i, 1u);
  EXPECT_EQ(graph.constraints.absolute[1].T_world_i.translation, Eigen::Vector3d(4, 5, 0));
}

TEST_F(G2oFile, HoldsAVertexThatIsFixedManyTimesOnce) {
  std::string all = "VERTEX_SE2 5 1 2 3\nVERTEX_SE2 6 4 5 6\nFIX 6";
  for (int k = 0; k < 1000; ++k) all += " 5";
  const auto graph = read(all + "\nFIX 6\n");
  ASSERT_EQ(graph.constraints.absolute.size(), 2u);
  EXPECT_EQ(graph.constraints.absolute[0].i, 1u);
}

TEST_F(G2oFile, IsRefusedWithItsLineWhenAVertexIsUnknown) {
  const std::string vertex = "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n";
  EXPECT_THAT(refusal(vertex + "EDGE_SE3:QUAT 0 9 0 0 0 0 0 0 1" + identity_triangle),
              HasSubstr(path.string() + ":2: vertex 9 is unknown"));
  EXPECT_THAT(refusal(vertex + "\nFIX 3\n"), HasSubstr(":3: vertex 3 is unknown"));
  EXPECT_THAT(refusal(vertex + "EDGE_SE3:QUAT 0 0 0 0 0 0 0 0 1" + identity_triangle),
              HasSubstr("to itself"));
  EXPECT_THAT(refusal(vertex + vertex), HasSubstr(":2: vertex 0 is given a second time"));
}

TEST_F(G2oFile, IsRefusedWithItsLineWhenALineIsDamaged) {
  EXPECT_THAT(refusal("VERTEX_SE3:QUAT 0 0 0 0 0 0 0\n"),
              HasSubstr(":1: VERTEX_SE3:QUAT takes 7 numbers after its vertices: there are fewer"));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0 0\n"), HasSubstr("there are more"));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 zero 0\n"), HasSubstr("'zero' is none"));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 nan 0\n"), HasSubstr("'nan' is none"));
  EXPECT_THAT(refusal("VERTEX_SE2 -1 0 0 0\n"),
              HasSubstr("'-1' after VERTEX_SE2 is not a vertex number"));
  EXPECT_THAT(refusal("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 0\n"), HasSubstr("norm 0"));
  for (const char* heading : {"1e308", "-1e307", "1.1e6"})
    EXPECT_THAT(refusal(std::string("VERTEX_SE2 0 0 0 ") + heading + "\n"),
                HasSubstr(":1: the heading is no angle"));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nEDGE_SE2 0 1 0 0 1e9 1 0 0 1 0 1\n"),
              HasSubstr(":3: the heading is no angle"));
  EXPECT_THAT(
      refusal("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nEDGE_SE2 0 1 0 0 0 1 0 0 1 0 1e308\n"),
      HasSubstr(":3: the information is too large"));
  EXPECT_THAT(refusal("VERTEX_SE3:QUAT 0 0 0 0 1e308 1e308 1e308 1e308\n"),
              HasSubstr("the quaternion is too large"));
  EXPECT_THAT(refusal("VERTEX_XY 0 0 0\n"), HasSubstr("unknown word 'VERTEX_XY'"));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0\nVERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n"),
              HasSubstr(":2: SE2 and SE3 stand in one file"));
  EXPECT_THAT(refusal("# nothing\n"), HasSubstr("holds no vertex"));
}

TEST_F(G2oFile, IsReadByTheStep) {
  read("VERTEX_SE2 3 1 0 0\nVERTEX_SE2 4 2 0 0\nEDGE_SE2 3 4 1 0 0 1 0 0 1 0 1\n");
  const Step& step = *plumb_module()->steps[0];
  PortOutput outputs[2];
  TestContext context;
  step.run(step.parameters({{"path", path.string()}}).get(), {}, outputs, context);
  EXPECT_EQ(outputs[0].one.as<Constraints>()->relative.size(), 1u);
  EXPECT_EQ(outputs[1].one.as<Poses>()->size(), 2u);
}

struct KnownFile {
  const char* name;
  std::size_t vertices, edges;
  bool planar;
};
class KnownGraph : public testing::TestWithParam<KnownFile> {};

TEST_P(KnownGraph, IsReadWhole) {
  const fs::path file = fs::path(PLUMB_SOURCE_DIR) / "../shared/data/graphs" / GetParam().name;
  if (!fs::exists(file)) GTEST_SKIP() << "needs " << file.string();
  const auto graph = read_g2o(file);
  EXPECT_EQ(graph.poses.size(), GetParam().vertices);
  EXPECT_EQ(graph.constraints.relative.size(), GetParam().edges);
  EXPECT_EQ(graph.constraints.planar, GetParam().planar);
}
INSTANTIATE_TEST_SUITE_P(Files, KnownGraph,
                         testing::Values(KnownFile{"intel.g2o", 1728, 2512, true},
                                         KnownFile{"parking-garage.g2o", 1661, 6275, false},
                                         KnownFile{"sphere2500.g2o", 2500, 4949, false}));

}  // namespace
}  // namespace plumb::source_g2o
