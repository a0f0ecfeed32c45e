/// Damaged files: each gives an Error or a cloud that the bytes can hold, and nothing else.

#include <gtest/gtest.h>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/slam/cloud_testing.hpp"
#include "plumb/slam/io/cloud_file.hpp"

namespace plumb {
namespace {

using io::TestFolder;

std::string little_packed() {
  std::string packed("\x0f\0\0\0\x24\0\0\0", 8);   // 15 bytes for 36
  packed += std::string("\x0b") + "abcdefghijkl";  // 12 literals
  packed += std::string("\xe0\x0f\x0b", 3);        // 24 more, from 12 back
  packed[0] = static_cast<char>(packed.size() - 8);
  return packed;
}

/// Files of every layout, and where the header of each ends.
std::vector<std::pair<std::string, std::string>> samples() {
  const Cloud cloud = full_cloud(7);
  const std::string fields =
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\nPOINTS 3\n";
  const std::string ply =
      "element face 1\nproperty list uchar int i\nelement vertex 2\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n";
  return {{"a.pcd", pcd_bytes(cloud)},
          {"b.pcd", fields + "DATA ascii\n1 2 3\n4 5 6\n7 8 9\n"},
          {"c.pcd", fields + "DATA binary_compressed\n" + little_packed()},
          {"d.ply", ply_bytes(cloud, "sample")},
          {"e.ply", "ply\nformat ascii 1.0\n" + ply + "1 0\n1 2 3\n4 5 6\n"},
          {"f.ply", "ply\nformat binary_little_endian 1.0\n" + ply +
                        std::string("\x01\0\0\0\0", 5) + std::string(24, '\x3f')}};
}

/// Reads the file; true if it gave a cloud. Whatever it gives is no larger than its bytes allow,
/// all arrays alike.
bool gives_a_sound_cloud(const std::filesystem::path& file, std::size_t bytes) {
  try {
    const auto [cloud, dropped] = read_cloud(file);
    EXPECT_LE(cloud.size() + dropped, 88 * bytes);
    EXPECT_EQ(cloud.y.size(), cloud.size());
    EXPECT_EQ(cloud.z.size(), cloud.size());
    for (const auto* values : {&cloud.intensity, &cloud.time, &cloud.nx, &cloud.ny, &cloud.nz})
      EXPECT_TRUE(values->empty() || values->size() == cloud.size());
    EXPECT_TRUE(cloud.ring.empty() || cloud.ring.size() == cloud.size());
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).rfind(file.string() + ":", 0), 0u) << error.what();
    return false;
  }
}

TEST(DamagedCloudFile, WithAHeaderOfHugePointsTakesNoMemoryForThem) {
  const TestFolder folder;
  std::string names = "FIELDS", sizes = "SIZE", types = "TYPE", counts = "COUNT";
  for (int k = 0; k < 1000; ++k)
    (names += " a") += std::to_string(k), sizes += " 8", types += " F", counts += " 65536";
  const std::string fields =
      names + " x y z\n" + sizes + " 4 4 4\n" + types + " F F F\n" + counts + " 1 1 1\n";
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    const auto of = [&](const std::string& points) {
      return folder.write("a.pcd", fields + "WIDTH " + points + "\nHEIGHT 1\nDATA " + data + "\n");
    };
    EXPECT_EQ(read_cloud(of("0")).cloud.size(), 0u);
    EXPECT_FALSE(gives_a_sound_cloud(of("1"), 40000)) << data;
    EXPECT_FALSE(gives_a_sound_cloud(of("18446744073709551615"), 40000)) << data;
  }
  const std::string ply = "property float x\nproperty float y\nproperty float z\nend_header\n";
  for (const std::string format : {"ascii", "binary_little_endian"}) {
    const std::string bytes = "ply\nformat " + format + " 1.0\nelement vertex 4000000000\n" + ply;
    EXPECT_FALSE(gives_a_sound_cloud(folder.write("a.ply", bytes), bytes.size())) << format;
  }
}

TEST(DamagedCloudFile, CutShortAnywhereIsRefused) {
  const TestFolder folder;
  for (const auto& [name, bytes] : samples()) {
    ASSERT_TRUE(gives_a_sound_cloud(folder.write(name, bytes), bytes.size())) << name;
    // Text may lose its last line end, or digits of its last number, and still be whole.
    const bool text = bytes.find("ascii") != std::string::npos;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const auto file = folder.write(name, bytes.substr(0, size));
      const bool whole = text && size + 1 == bytes.size();
      EXPECT_EQ(gives_a_sound_cloud(file, size), whole) << name << " cut to " << size;
    }
  }
}

TEST(DamagedCloudFile, WithAnyByteChangedGivesACloudOrAnError) {
  const TestFolder folder;
  for (const auto& [name, bytes] : samples())
    for (std::size_t place = 0; place < bytes.size(); ++place)
      for (const unsigned char change : {0x01, 0x08, 0x40, 0xff}) {
        std::string damaged = bytes;
        damaged[place] = static_cast<char>(damaged[place] ^ change);
        gives_a_sound_cloud(folder.write(name, damaged), bytes.size());
      }
}

}  // namespace
}  // namespace plumb
