#include "plumb/slam/io/cloud_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/slam/cloud_testing.hpp"
#include "plumb/slam/io/lzf.hpp"

namespace plumb {
namespace {

using io::refusal;
using io::TestFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::FloatEq;
using testing::HasSubstr;
using testing::StartsWith;

template <class... T>
std::string raw(const T&... values) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
  return bytes;
}

void expect_same(const Cloud& a, const Cloud& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.z, b.z);
  EXPECT_EQ(a.intensity, b.intensity);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.ring, b.ring);
  EXPECT_EQ(a.nx, b.nx);
  EXPECT_EQ(a.ny, b.ny);
  EXPECT_EQ(a.nz, b.nz);
}

TEST(CloudFile, GivesBackEveryArrayOfACloudWrittenAsPcdOrPly) {
  const TestFolder folder;
  Cloud plain;
  plain.add({1, 2, 3});
  for (const Cloud& cloud : {full_cloud(100), plain, Cloud()}) {
    const auto pcd = read_cloud(folder.write("a.pcd", pcd_bytes(cloud)));
    const auto ply = read_cloud(folder.write("a.ply", ply_bytes(cloud, "made by\na test")));
    expect_same(pcd.cloud, cloud);
    expect_same(ply.cloud, cloud);
    EXPECT_EQ(pcd.dropped + ply.dropped, 0u);
  }
}

TEST(CloudFile, BeginsAsItsHeaderAlone) {
  Cloud cloud;
  for (int k = 0; k < 12; ++k) cloud.add({1, 2, 3});
  std::string points;
  for (int k = 0; k < 12; ++k) points += raw(1.0f, 2.0f, 3.0f);
  EXPECT_EQ(ply_header(12, "made by a test") + points, ply_bytes(cloud, "made by a test"));
  EXPECT_EQ(pcd_header(12) + points, pcd_bytes(cloud));
}

TEST(CloudFile, ReadsAnAsciiPcdWrittenByHand) {
  const TestFolder folder;
  const auto file =
      folder.write("a.pcd",
                   "# .PCD v0.7\r\nVERSION 0.7\r\nFIELDS x y z rgb intensity\nSIZE 4 4 4 4 4\n"
                   "TYPE F F F U F\nCOUNT 1 1 1 2 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
                   "POINTS 2\nDATA ascii\n1 2 3 255 0 0.5\n\n -1.5e1\t+2.25 .5 1 2 7\n");
  const auto [cloud, dropped] = read_pcd(file);
  EXPECT_THAT(cloud.x, ElementsAre(1, -15));
  EXPECT_THAT(cloud.y, ElementsAre(2, 2.25));
  EXPECT_THAT(cloud.z, ElementsAre(3, 0.5));
  EXPECT_THAT(cloud.intensity, ElementsAre(0.5, 7));
  EXPECT_EQ(dropped, 0u);
}

TEST(CloudFile, ConvertsDoublesIntegersAndNanoseconds) {
  const TestFolder folder;
  const auto file =
      folder.write("a.pcd",
                   "FIELDS _ x y z intensity ring t\nSIZE 1 8 8 8 1 1 4\nTYPE U F F F U U U\nCOUNT "
                   "3 1 1 1 1 1 1\n"
                   "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA binary\n" +
                       raw('a', 'b', 'c', 1.5, 2.5, 3.5, std::uint8_t(200), std::uint8_t(63)) +
                       raw(50'000'000u) +
                       raw('a', 'b', 'c', -1.0, -2.0, -3.0, std::uint8_t(1), std::uint8_t(0)) +
                       raw(100'000'000u));
  const Cloud cloud = read_pcd(file).cloud;
  EXPECT_THAT(cloud.x, ElementsAre(1.5, -1));
  EXPECT_THAT(cloud.z, ElementsAre(3.5, -3));
  EXPECT_THAT(cloud.intensity, ElementsAre(200, 1));
  EXPECT_THAT(cloud.ring, ElementsAre(63, 0));
  EXPECT_THAT(cloud.time, ElementsAre(FloatEq(0.05f), FloatEq(0.1f)));
}

TEST(CloudFile, DropsAndCountsPointsThatAreNowhere) {
  const TestFolder folder;
  Cloud cloud = full_cloud(5);
  cloud.x[1] = std::numeric_limits<float>::quiet_NaN();
  cloud.z[4] = -std::numeric_limits<float>::infinity();
  for (const auto& file :
       {folder.write("a.pcd", pcd_bytes(cloud)), folder.write("a.ply", ply_bytes(cloud))}) {
    const auto [read, dropped] = read_cloud(file);
    EXPECT_EQ(dropped, 2u);
    expect_same(read, select(full_cloud(5), {0, 2, 3}));
  }
  const auto text =
      folder.write("b.pcd",
                   "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 3\nHEIGHT 1\nPOINTS 3\n"
                   "DATA ascii\nnan 1 2\n1 2 3\n4 -inf 0\n");
  EXPECT_EQ(read_pcd(text).dropped, 2u);
  EXPECT_THAT(read_pcd(text).cloud.x, ElementsAre(1));
}

TEST(CloudFile, UnpacksCompressedPcd) {
  // x is 1 2 3, y and z are zeros: 12 literal bytes, then one zero and a copy of 23 bytes from 1
  // back.
  const std::string packed = raw(char(11), 1.0f, 2.0f, 3.0f) + raw(char(0), char(0)) +
                             raw(char(7 << 5), char(23 - 9), char(0));
  const std::string header =
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA binary_compressed\n";
  const TestFolder folder;
  const auto sizes = [&](std::uint32_t unpacked) {
    return raw(std::uint32_t(packed.size()), unpacked);
  };
  const Cloud cloud = read_pcd(folder.write("a.pcd", header + sizes(36) + packed)).cloud;
  EXPECT_THAT(cloud.x, ElementsAre(1, 2, 3));
  EXPECT_THAT(cloud.y, ElementsAre(0, 0, 0));
  EXPECT_THAT(cloud.z, ElementsAre(0, 0, 0));
  const auto said = [&](const std::string& bytes) {
    return refusal([&] { read_pcd(folder.write("b.pcd", bytes)); });
  };
  EXPECT_THAT(said(header + sizes(48) + packed), HasSubstr("48 bytes are packed"));
  EXPECT_THAT(said(header + sizes(36) + packed.substr(1)), HasSubstr("cut short"));
  EXPECT_THAT(said(header + sizes(36) + std::string(packed.size(), '\xff')), HasSubstr("damaged"));
  EXPECT_THAT(said(header), HasSubstr("cut short"));
}

TEST(Lzf, RefusesSizesThatNoPackedBytesCouldGive) {
  std::string result;
  EXPECT_FALSE(io::unpack_lzf("abc", std::size_t(1) << 60, result));
  EXPECT_TRUE(io::unpack_lzf("", 0, result));
  EXPECT_FALSE(io::unpack_lzf(std::string(1, '\x03') + "ab", 4, result)) << "literals cut short";
  EXPECT_FALSE(io::unpack_lzf(std::string("\x20\x00", 2), 3, result))
      << "copy from before the start";
}

TEST(CloudFile, ReadsAPlyOfAnotherProgramWithElementsBeforeAndAfterItsVertices) {
  const TestFolder folder;
  const std::string elements =
      "comment by hand\nelement camera 2\nproperty list uchar int ids\nproperty short a\nelement "
      "vertex 2\n"
      "property double x\nproperty double y\nproperty double z\nproperty uchar red\nproperty float "
      "scalar_Intensity\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto ascii = folder.write("a.ply", "ply\nformat ascii 1.0\n" + elements +
                                               "2 5 6 1\n0 1\n1 2 3 255 9\n4 5 6 0 8\n3 0 1 1\n");
  const auto binary = folder.write(
      "b.ply", "ply\nformat binary_little_endian 1.0\n" + elements + raw(char(2)) + raw(5, 6) +
                   raw(short(1)) + raw(char(0)) + raw(short(1)) + raw(1.0, 2.0, 3.0, char(-1)) +
                   raw(9.0f) + raw(4.0, 5.0, 6.0, char(0)) + raw(8.0f) + raw(char(3)) +
                   raw(0, 1, 1));
  for (const auto& file : {ascii, binary}) {
    const Cloud cloud = read_ply(file).cloud;
    EXPECT_THAT(cloud.x, ElementsAre(1, 4)) << file;
    EXPECT_THAT(cloud.y, ElementsAre(2, 5));
    EXPECT_THAT(cloud.z, ElementsAre(3, 6));
    EXPECT_THAT(cloud.intensity, ElementsAre(9, 8));
  }
}

TEST(CloudFile, RefusesWrongFilesWithThePathAndTheCure) {
  const TestFolder folder;
  const auto said = [&](const std::string& bytes, const std::string& name = "a.pcd") {
    const auto file = folder.write(name, bytes);
    const auto sentence = refusal([&] { read_cloud(file); });
    EXPECT_THAT(sentence, StartsWith(file.string() + ":"));
    return sentence;
  };
  const std::string fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  EXPECT_THAT(
      said(fields + "WIDTH 1000000000000\nHEIGHT 1\nPOINTS 1000000000000\nDATA binary\n1234"),
      AllOf(HasSubstr("promises 1000000000000 points"), HasSubstr("only 4 bytes")));
  EXPECT_THAT(said(fields + "POINTS 1000000000000\nDATA ascii\n1 2 3\n"),
              HasSubstr("promises 1000000000000"));
  EXPECT_THAT(said(fields + "POINTS 1000000000000\nDATA binary_compressed\n12345678"),
              HasSubstr("packed"));
  EXPECT_THAT(said(fields + "WIDTH 5000000000\nHEIGHT 5000000000\nDATA binary\n"),
              HasSubstr("too large"));
  EXPECT_THAT(said(fields + "POINTS 18446744073709551615\nDATA binary\n"), HasSubstr("promises"));
  EXPECT_THAT(said(fields + "POINTS -1\nDATA binary\n"),
              HasSubstr("'-1' where a whole number belongs"));
  EXPECT_THAT(said(fields + "POINTS 2\nWIDTH 3\nHEIGHT 1\nDATA binary\n"),
              HasSubstr("WIDTH times HEIGHT"));
  EXPECT_THAT(said(fields + "POINTS 2\nDATA ascii\n1 2 3\n    \n"), HasSubstr("cut short"));
  EXPECT_THAT(said(fields + "POINTS 2\nDATA ascii\n1 2 3\n1 2 x3\n"),
              AllOf(HasSubstr(":8:"), HasSubstr("'x3'")));
  EXPECT_THAT(said(fields + "POINTS 2\nDATA ascii\n1 2 3 4\n5 6 7\n"), HasSubstr("has 4 numbers"));
  EXPECT_THAT(said("FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 0\nDATA binary\n"),
              HasSubstr("no field 'z'"));
  EXPECT_THAT(said("FIELDS x y z\nSIZE 4 4 4\nTYPE F F I\nPOINTS 0\nDATA binary\n"),
              HasSubstr("integers"));
  EXPECT_THAT(said("FIELDS x y z\nSIZE 4 4\n"), HasSubstr("2 entries for 3 FIELDS"));
  EXPECT_THAT(said("FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\nPOINTS 0\nDATA binary\n"),
              HasSubstr("SIZE 3"));
  EXPECT_THAT(said(fields + "POINTS 0\nDATA zip\n"), HasSubstr("'zip'"));
  EXPECT_THAT(said(""), HasSubstr("DATA"));
  EXPECT_THAT(said("\x01\x02 garbage\n"), HasSubstr("not a PCD file"));
  EXPECT_THAT(said("", "a.ply"), HasSubstr("not a PLY file"));
  EXPECT_THAT(said("ply\nformat binary_big_endian 1.0\n", "a.ply"),
              HasSubstr("binary_little_endian"));
  EXPECT_THAT(said("ply\nformat ascii 1.0\nelement vertex 1000000000000\nproperty float "
                   "x\nproperty float y\n"
                   "property float z\nend_header\n1 2 3\n",
                   "a.ply"),
              HasSubstr("promises 1000000000000"));
  EXPECT_THAT(said("ply\nformat binary_little_endian 1.0\nelement face 1000000000000\nproperty "
                   "list uchar int i\n"
                   "end_header\n\x01",
                   "a.ply"),
              HasSubstr("cut short"));
  EXPECT_THAT(said("ply\nformat ascii 1.0\nelement edge 0\nend_header\n", "a.ply"),
              HasSubstr("no element 'vertex'"));
  EXPECT_THAT(said("1 2 3", "a.xyz"), HasSubstr("'.xyz'"));
  const auto missing = folder.path() / "none.pcd";
  EXPECT_THAT(refusal([&] { read_cloud(missing); }),
              AllOf(StartsWith(missing.string()), HasSubstr("No such file")));
  EXPECT_THAT(refusal([&] { read_pcd(folder.path()); }), HasSubstr("not a regular file"));
}

}  // namespace
}  // namespace plumb
