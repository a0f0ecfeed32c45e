#include <bzlib.h>
#include <gmock/gmock.h>
#include <zlib.h>

#include <cmath>
#include <numbers>

#include "plumb/slam/io/source_testing.hpp"

namespace plumb::source_carmen {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// `value` a beam, but that of beam k is `special[k]`.
std::string ranges(std::size_t n, const std::string& value,
                   const std::map<std::size_t, std::string>& special = {}) {
  std::string text = std::to_string(n);
  for (std::size_t k = 0; k < n; ++k) text += " " + (special.contains(k) ? special.at(k) : value);
  return text;
}
std::string flaser(const std::string& readings, double stamp,
                   const std::string& poses = "1 2 0 1 2 0") {
  return "FLASER " + readings + " " + poses + " " + std::to_string(stamp) + " nohost 0.5\n";
}
/// Two scans of 180 beams at stamps 10 and 11 that see a wall at 2 m; the robot has moved by 1 m
/// between them.
const std::string two_scans =
    "# comment\nPARAM robot_use_laser on nohost 0\nODOM 0 0 0 0 0 0 10 nohost 0\n" +
    flaser(ranges(180, "2.00"), 10, "0 0 0 0 0 0") + flaser(ranges(180, "2.00"), 11, "1 0 0 1 0 0");

std::string bzipped(std::string text) {
  std::string packed(text.size() + 1000, '\0');
  auto size = static_cast<unsigned>(packed.size());
  BZ2_bzBuffToBuffCompress(packed.data(), &size, text.data(), static_cast<unsigned>(text.size()), 9,
                           0, 0);
  packed.resize(size);
  return packed;
}
std::string gzipped(std::string text) {
  std::string packed(text.size() + 1000, '\0');
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  stream.next_in = reinterpret_cast<Bytef*>(text.data());
  stream.avail_in = static_cast<unsigned>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<unsigned>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(packed.size() - stream.avail_out);
  deflateEnd(&stream);
  return packed;
}

struct CarmenLogs : testing::Test {
  io::TestFolder folder;
  SourceResult read(const std::string& bytes, ParameterValues values = {}) const {
    values["path"] = folder.write("some.log", bytes).string();
    return read_source(values);
  }
  std::string refused(const std::string& bytes) const {
    return io::refusal([&] { read(bytes); });
  }
};

void expect_point(const Cloud& cloud, std::size_t k, double x, double y) {
  ASSERT_LT(k, cloud.size());
  EXPECT_NEAR(cloud.x[k], x, 1e-6);
  EXPECT_NEAR(cloud.y[k], y, 1e-6);
  EXPECT_EQ(cloud.z[k], 0);
}

TEST_F(CarmenLogs, GiveScansAsPointsBeforeTheLaserAndPosesByOdometry) {
  auto log = read(two_scans);
  ASSERT_EQ(log.frames.keys.size(), 2u);
  EXPECT_THAT(log.trajectory.stamps, ElementsAre(10, 11));
  EXPECT_EQ(log.trajectory.T_world_frame[1].translation, Eigen::Vector3d(1, 0, 0));
  const Cloud cloud = log.cloud(1);
  ASSERT_EQ(cloud.size(), 180u);
  expect_point(cloud, 0, 0, -2);  // to the right
  expect_point(cloud, 90, 2, 0);  // ahead
  expect_point(cloud, 179, 2 * std::cos(89 * std::numbers::pi / 180),
               2 * std::sin(89 * std::numbers::pi / 180));
  EXPECT_EQ(log.count("scans read"), 2u);
  EXPECT_EQ(log.count("odometry lines beside the scans"), 1u);
  EXPECT_TRUE(log.context.warnings.empty());
}

TEST_F(CarmenLogs, SpreadTheirBeamsAsCarmenDoesOrOverAGivenFieldOfView) {
  const auto first_and_last = [&](std::size_t beams, ParameterValues values = {}) {
    auto log =
        read(flaser(ranges(beams, "1"), 1) + flaser(ranges(beams, "1"), 2, "1 0 0 1 0 0"), values);
    const Cloud cloud = log.cloud(0);
    const auto degrees = [&](std::size_t k) {
      return std::atan2(cloud.y[k], cloud.x[k]) * 180 / std::numbers::pi;
    };
    EXPECT_EQ(log.context.warnings.size(),
              beams == 100 && !values.contains("field_of_view") ? 1u : 0u);
    return std::make_pair(degrees(0), degrees(beams - 1));
  };
  EXPECT_NEAR(first_and_last(181).second, 90, 1e-4);
  EXPECT_NEAR(first_and_last(361).first, -90, 1e-4);
  EXPECT_NEAR(first_and_last(361).second, 90, 1e-4);
  EXPECT_NEAR(first_and_last(360).second, 89.5, 1e-4);
  EXPECT_NEAR(first_and_last(1081).second, 135, 1e-4);
  EXPECT_NEAR(first_and_last(100).second, 90, 1e-4);  // a guess, with a warning
  const auto given = first_and_last(181, {{"field_of_view", std::numbers::pi / 2}});
  EXPECT_NEAR(given.first, -45, 1e-4);
  EXPECT_NEAR(given.second, 45, 1e-4);
}

TEST_F(CarmenLogs, KeepTheFilesOrderWhenStampsStepBack) {
  auto log =
      read(flaser(ranges(3, "1"), 5) + flaser(ranges(3, "1"), 4.5) + flaser(ranges(3, "1"), 6));
  EXPECT_THAT(log.trajectory.stamps, ElementsAre(5, 4.5, 6));
  EXPECT_EQ(log.count("stamps out of order kept in the file's order"), 1u);
}

TEST_F(CarmenLogs, GiveTheIdentityWhereOdometryIsIgnored) {
  auto log = read(two_scans, {{"odometry", std::string("ignore")}});
  EXPECT_THAT(log.trajectory.stamps, ElementsAre(10, 11));
  EXPECT_TRUE(log.trajectory.T_world_frame[1].translation.isZero());
  EXPECT_TRUE(log.context.warnings.empty());
}

TEST_F(CarmenLogs, PutTheLaserWhereItIsMounted) {
  const auto at = [](auto log) { return log.trajectory.T_world_frame[1].translation; };
  const auto scan = [](int stamp, const std::string& poses) {
    return flaser(ranges(3, "1"), stamp, poses);
  };
  // As both poses say: 0.2 m ahead of a robot that looks along y.
  const std::string left = "1.5707963267948966";
  auto log = read(scan(1, "0.2 0 0 0 0 0") + scan(2, "5 6.2 " + left + " 5 6 " + left));
  EXPECT_LT((at(log) - Eigen::Vector3d(5, 6.2, 0)).norm(), 1e-9);
  // Corrected poses in the laser's place: odometry and the parameter count.
  log = read("PARAM robot_frontlaser_offset 0.1 nohost 0\n" + scan(1, "0 0 0 0 0 0") +
             scan(2, "7 7 1 5 6 0"));
  EXPECT_LT((at(log) - Eigen::Vector3d(5.1, 6, 0)).norm(), 1e-9);
}

TEST_F(CarmenLogs, ReadNewerMessagesWithTheirOwnAnglesAndMaximum) {
  const auto robot_laser = [](double stamp, const std::string& x) {
    return "ROBOTLASER1 0 -0.5 1.0 0.5 30 0.01 0 3 1 2 30 2 17 18 " + x + " 0 0 " + x +
           " 0 0 0 0 0 0 0 " + std::to_string(stamp) + " host 1\n";
  };
  auto log = read(robot_laser(1, "0") + "RAWLASER1 0 -0.5 1.0 0.5 30 0.01 0 3 1 2 30 0 1 host 1\n" +
                  robot_laser(2, "3"));
  ASSERT_EQ(log.frames.keys.size(), 2u);
  EXPECT_EQ(log.count("other messages of the same laser left out"), 1u);
  EXPECT_EQ(log.count("beams that saw nothing dropped"), 2u);
  EXPECT_EQ(log.trajectory.T_world_frame[1].translation.x(), 3);
  const Cloud cloud = log.cloud(0);
  ASSERT_EQ(cloud.size(), 2u);
  expect_point(cloud, 0, std::cos(0.5), -std::sin(0.5));
  expect_point(cloud, 1, 2, 0);
}

TEST_F(CarmenLogs, PlaceRawScansBetweenTheOdometryLinesRoundThem) {
  const auto raw = [](double stamp) {
    return "RAWLASER1 0 -0.5 1.0 0.5 30 0.01 0 3 1 2 3 0 " + std::to_string(stamp) + " host 1\n";
  };
  auto log =
      read("ODOM 0 0 3.1 0 0 0 1 host 0\n" + raw(1.25) + "ODOM 4 0 -3.1 0 0 0 2 host 0\n" + raw(3));
  EXPECT_LT((log.trajectory.T_world_frame[0].translation - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((log.trajectory.T_world_frame[1].translation - Eigen::Vector3d(4, 0, 0)).norm(), 1e-12);
  // From 3.1 on to -3.1 it turns by 0.083 rad, not back by 6.2.
  EXPECT_NEAR(angle(log.trajectory.T_world_frame[0]), 3.1 + 0.25 * (2 * std::numbers::pi - 6.2),
              1e-9);
}

TEST_F(CarmenLogs, WarnWhereThereIsNoOdometry) {
  auto log = read(flaser(ranges(181, "1"), 1) + flaser(ranges(181, "1"), 2));
  EXPECT_THAT(log.context.warnings,
              ElementsAre(HasSubstr("has no odometry, or the robot never moves by it")));
  log = read(
      "RAWLASER1 0 -0.5 1.0 0.5 30 0 0 1 1 0 1 h 1\nRAWLASER1 0 -0.5 1.0 0.5 30 0 0 1 1 0 2 h 1\n");
  EXPECT_THAT(log.context.warnings, ElementsAre(HasSubstr("has no odometry")));
  EXPECT_EQ(log.trajectory.size(), 2u);
}

TEST_F(CarmenLogs, DropWhatTheMaximumOfTheLogSaysWasNotSeen) {
  // 50.00 repeats; 49.8 is a reading beside it; 81.91 is one glitch.
  std::string text;
  for (std::size_t k = 0; k < 20; ++k)
    text += flaser(
        ranges(
            180, "4.00",
            {{k, "50.00"}, {k + 30, "50.00"}, {90, "20." + std::to_string(10 + k)}, {91, "49.80"}}),
        static_cast<double>(k));
  auto log = read(text + flaser(ranges(180, "4.00", {{0, "81.91"}}), 30));
  EXPECT_EQ(log.count("beams that saw nothing dropped"), 20u * 3 + 1);
  EXPECT_EQ(log.cloud(0).size(), 177u);
  EXPECT_EQ(log.cloud(20).size(), 179u);
  EXPECT_EQ(read(text, {{"max_range", 10.0}}).count("beams that saw nothing dropped"), 20u * 4);
  EXPECT_EQ(read(text, {{"max_range", 60.0}}).count("beams that saw nothing dropped"), 0u);
}

TEST_F(CarmenLogs, KeepEverythingWhereNoReadingSticksOut) {
  std::string text;  // 3600 readings from 1 to 10 m, each once
  for (int k = 0; k < 20; ++k) {
    std::string line = "180";
    for (int b = 0; b < 180; ++b) line += " " + std::to_string(1 + 0.0025 * (20 * b + k));
    text += flaser(line, k);
  }
  EXPECT_EQ(read(text).count("beams that saw nothing dropped"), 0u);
  // Far walls before a robot that stands still repeat, but always in the same beams.
  text.clear();
  for (int k = 0; k < 50; ++k)
    text += flaser(ranges(180, "3.00", {{89, "20.01"}, {90, "20.00"}, {91, "20.01"}}), k);
  EXPECT_EQ(read(text).count("beams that saw nothing dropped"), 0u);
}

TEST_F(CarmenLogs, DropZerosNearReadingsAndWhatIsNoNumber) {
  auto log = read(
      flaser(ranges(180, "3.00", {{0, "0"}, {1, "0.03"}, {2, "nan"}, {3, "-1"}, {4, "inf"}}), 1) +
      two_scans);
  EXPECT_EQ(log.count("beams nearer than min_range dropped"), 2u);
  EXPECT_EQ(log.count("beams with a non-finite range dropped"), 2u);
  EXPECT_EQ(log.count("beams that saw nothing dropped"), 1u);
  EXPECT_EQ(log.cloud(0).size(), 175u);
  EXPECT_EQ(read(two_scans, {{"min_range", 2.5}}).cloud(0).size(), 0u);
}

TEST_F(CarmenLogs, KnowAFrameByItsContent) {
  const auto keys = read(two_scans).frames.keys;
  EXPECT_EQ(read(gzipped(two_scans)).frames.keys, keys);
  auto other = read(two_scans + flaser(ranges(180, "3.00"), 12)).frames.keys;
  EXPECT_EQ(other[0], keys[0]);
  EXPECT_NE(other[2], keys[0]);
}

TEST_F(CarmenLogs, AreUnpackedByWhatTheyHoldWhateverTheirName) {
  for (const auto& packed : {bzipped(two_scans), gzipped(two_scans),
                             bzipped(two_scans.substr(0, 100)) + bzipped(two_scans.substr(100)),
                             gzipped(two_scans.substr(0, 100)) + gzipped(two_scans.substr(100)) +
                                 std::string(512, '\0')})
    EXPECT_EQ(read(packed).trajectory.stamps, read(two_scans).trajectory.stamps);
}

TEST_F(CarmenLogs, AreRefusedWhenTheirPackedDataAreCutOrDamaged) {
  std::string noise;
  for (std::uint32_t k = 1, x = 1; k < 30000; ++k)
    noise += std::to_string(x = x * 1664525u + 1013904223u) + "\n";
  for (const auto& [packed, name] :
       {std::pair(bzipped(noise), "bzip2"), std::pair(gzipped(noise), "gzip")}) {
    for (const std::size_t size : {packed.size() - 1, packed.size() / 2, std::size_t{20}})
      EXPECT_THAT(refused(packed.substr(0, size)),
                  HasSubstr(std::string("is cut off: its ") + name))
          << size;
    std::string damaged = packed;
    for (std::size_t k = 0; k < 40; ++k) damaged[packed.size() / 2 + k] = '\x55';
    EXPECT_THAT(refused(damaged), HasSubstr("is damaged: its " + std::string(name)));
    EXPECT_THAT(refused(packed + "FLASER"), HasSubstr("other bytes follow"));
  }
}

TEST_F(CarmenLogs, AreRefusedWhenTheirPackedDataHoldFarMoreThanALog) {
  const std::string same(std::size_t{64} << 20, 'a');
  EXPECT_THAT(refused(bzipped(same)), HasSubstr("unpacks to more than 8 MiB"));
  EXPECT_THAT(refused(gzipped(same)),
              HasSubstr("if it is a log, unpack it with gzip -d and give that"));
  std::string pieces;  // many small streams
  for (int k = 0; k < 40; ++k) pieces += bzipped(std::string(1 << 20, 'b'));
  EXPECT_THAT(refused(pieces), HasSubstr("unpacks to more than 8 MiB"));
  std::string empty = bzipped(two_scans);  // and streams without anything
  for (int k = 0; k < 2000; ++k) empty += bzipped("");
  EXPECT_EQ(read(empty).trajectory.stamps, read(two_scans).trajectory.stamps);
}

TEST_F(CarmenLogs, LeaveOutDamagedScansWithOneWarning) {
  const std::string good = two_scans;
  const std::string damaged = "FLASER 180 1.0 1.0\n" +                         // cut
                              flaser("4 1 1 1", 12) + flaser("2 1 1 1", 12) +  // wrong counts
                              flaser(ranges(3, "x"), 12) +                     // no number
                              flaser(ranges(3, "1"), 12, "1 2 nan 1 2 0") +    // no pose
                              flaser("99999999999 1 1", 12) + flaser("-3 1 1 1", 12) +
                              flaser("0", 12) + "FLASER\n";
  auto log = read(good + damaged);
  EXPECT_EQ(log.frames.keys.size(), 2u);
  EXPECT_EQ(log.count("damaged scans left out"), 9u);
  ASSERT_EQ(log.context.warnings.size(), 1u);
  EXPECT_THAT(log.context.warnings[0], HasSubstr("some.log:6: "));
}

TEST_F(CarmenLogs, LeaveOutScansWhoseBeamsPointNowhere) {
  const auto scan = [](const std::string& start, const std::string& step, double stamp) {
    return "ROBOTLASER1 0 " + start + " 1.0 " + step +
           " 30 0.01 0 3 1 2 30 0 0 0 0 0 0 0 0 0 0 0 0 " + std::to_string(stamp) + " host 1\n";
  };
  auto log = read(scan("-0.5", "0.5", 1) + scan("-0.5", "0.5", 2) + scan("inf", "0.5", 3) +
                  scan("-inf", "0.5", 4) + scan("0", "1e999", 5) + scan("nan", "0.5", 6));
  EXPECT_EQ(log.frames.keys.size(), 2u);
  EXPECT_EQ(log.count("damaged scans left out"), 4u);
}

TEST_F(CarmenLogs, CountLinesThatAreNoMessage) {
  auto log = read("garbage line\n\n# a comment\nTRUEPOS 1 2 3\n" + two_scans + "180 1.0 1.0\n");
  EXPECT_EQ(log.frames.keys.size(), 2u);
  EXPECT_EQ(log.count("lines without a CARMEN message left out"), 2u);
}

TEST_F(CarmenLogs, SurviveBeingCutAnywhere) {
  for (std::size_t size = 0; size < two_scans.size(); size += 7) {
    const std::string said = refused(two_scans.substr(0, size));
    EXPECT_THAT(said, testing::AnyOf(HasSubstr("nothing was refused"), HasSubstr("is empty"),
                                     HasSubstr("has no laser scan"), HasSubstr("has 1 whole scan"),
                                     HasSubstr("laser messages are damaged")));
  }
}

TEST_F(CarmenLogs, UseTheFrontLaserOfTwo) {
  std::string rear = flaser(ranges(180, "9"), 10);
  rear.replace(0, 6, "RLASER");
  auto log = read(rear + two_scans + rear);
  EXPECT_EQ(log.frames.keys.size(), 2u);
  EXPECT_EQ(log.count("scans of a second laser left out"), 2u);
  EXPECT_THAT(refused(rear), HasSubstr("it has a rear laser only"));
}

TEST_F(CarmenLogs, AreRefusedWhenThereIsNothingInThem) {
  EXPECT_THAT(refused(""), HasSubstr("is empty"));
  EXPECT_THAT(refused(" \n\n"), HasSubstr("is empty"));
  EXPECT_THAT(refused("ply\nformat ascii 1.0\n"),
              HasSubstr("has no laser scan: expected a CARMEN log"));
  EXPECT_THAT(refused("ODOM 0 0 0 0 0 0 10 nohost 0\n"), HasSubstr("has no laser scan"));
  EXPECT_THAT(refused(flaser(ranges(3, "1"), 1)), HasSubstr("has 1 whole scan"));
  EXPECT_THAT(refused("\nFLASER 3 1\nFLASER\n"),
              HasSubstr("some.log:2: all 2 laser messages are damaged"));
}

}  // namespace
}  // namespace plumb::source_carmen
