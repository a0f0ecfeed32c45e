/// A CARMEN log as MRPT's programs read it: one pair of action and sensory frame a scan.
///
///   carmen_to_rawlog LOG OUT.rawlog SCANS.txt [FIRST]     LOG: plain text, or - for the standard
///   input
///
/// SCANS.txt has a line a scan, `stamp x y theta`: the log's own stamp (third word from the end)
/// and the laser's pose by the wheels. MRPT's time must not step back, as the stamps of some logs
/// do: in the rawlog such a scan comes a millisecond after the one before; results are brought back
/// to the log's stamps by their order. FIRST: only the first so many scans.

#include <mrpt/core/Clock.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr double pi = 3.14159265358979323846;

struct Scan {
  std::string stamp;  // as the log has it
  double start, step, maximum;
  std::vector<double> ranges;
  mrpt::poses::CPose2D pose;
};

double number(const std::vector<std::string>& words, std::size_t k) {
  return std::stod(words.at(k));
}

/// `FLASER n [n ranges] laser_pose robot_pose stamp host logger_stamp`, beams as CARMEN has them:
/// from 90 degrees on the right, a step of 1 degree with 180 or 181 of them, of half a degree with
/// 360 or 361.
Scan flaser(const std::vector<std::string>& words) {
  const auto n = static_cast<std::size_t>(std::stoul(words.at(1)));
  if (n < 2 || words.size() != n + 11)
    throw std::runtime_error("FLASER with a wrong number of words");
  Scan scan{words[n + 8],
            -pi / 2,
            pi / static_cast<double>(n % 2 == 0 ? n : n - 1),
            0,
            {},
            {number(words, n + 2), number(words, n + 3), number(words, n + 4)}};
  for (std::size_t k = 0; k < n; ++k) scan.ranges.push_back(number(words, 2 + k));
  return scan;
}

/// `ROBOTLASER1 type start fov step max accuracy mode n [ranges] m [remissions] laser_pose
/// robot_pose ... stamp host stamp`.
Scan robotlaser(const std::vector<std::string>& words) {
  const auto n = static_cast<std::size_t>(std::stoul(words.at(8)));
  const auto m = static_cast<std::size_t>(std::stoul(words.at(9 + n)));
  const std::size_t pose = 10 + n + m;
  if (n < 2 || words.size() != pose + 14)
    throw std::runtime_error("ROBOTLASER1 with a wrong number of words");
  Scan scan{words[pose + 11],
            number(words, 2),
            number(words, 4),
            number(words, 5),
            {},
            {number(words, pose), number(words, pose + 1), number(words, pose + 2)}};
  for (std::size_t k = 0; k < n; ++k) scan.ranges.push_back(number(words, 9 + k));
  return scan;
}

std::vector<Scan> scans_of(std::istream& log, std::size_t first) {
  std::vector<Scan> scans;
  std::size_t left_out = 0;
  for (std::string line; scans.size() < first && std::getline(log, line);) {
    const bool is_flaser = line.rfind("FLASER ", 0) == 0;
    if (!is_flaser && line.rfind("ROBOTLASER1 ", 0) != 0) continue;
    std::istringstream in(line);
    const std::vector<std::string> words{std::istream_iterator<std::string>(in), {}};
    try {
      scans.push_back(is_flaser ? flaser(words) : robotlaser(words));
    } catch (const std::exception&) {
      ++left_out;
    }
  }
  if (left_out > 0) std::cerr << "carmen_to_rawlog: " << left_out << " damaged scans left out\n";
  return scans;
}

/// Where the log does not say what a scanner reads when it sees nothing: just under the largest
/// reading that at least one in 10,000 has; 80 m where there is none.
double maximum_of(const std::vector<Scan>& scans) {
  std::vector<double> all;
  for (const Scan& scan : scans) all.insert(all.end(), scan.ranges.begin(), scan.ranges.end());
  std::sort(all.begin(), all.end(), std::greater<>());
  for (std::size_t k = 0; k < all.size();) {
    const auto end = std::find_if(all.begin() + static_cast<std::ptrdiff_t>(k), all.end(),
                                  [&](double v) { return v < all[k] - 1e-3; });
    const auto count = static_cast<std::size_t>(end - all.begin()) - k;
    if (count * 10000 > all.size()) return 0.99 * all[k];
    k += count;
  }
  return 80;
}

mrpt::obs::CObservation2DRangeScan observation(const Scan& scan, double maximum,
                                               mrpt::system::TTimeStamp stamp) {
  mrpt::obs::CObservation2DRangeScan made;
  const double view = scan.step * static_cast<double>(scan.ranges.size() - 1);
  made.aperture = static_cast<float>(view);
  made.rightToLeft = true;  // counted from the right to the left
  made.maxRange = static_cast<float>(maximum);
  made.sensorLabel = "LASER";
  made.timestamp = stamp;
  // MRPT's beams lie evenly about straight ahead: what is left over turns the sensor.
  made.sensorPose = mrpt::poses::CPose3D(0, 0, 0, scan.start + 0.5 * view, 0, 0);
  made.resizeScan(scan.ranges.size());
  for (std::size_t k = 0; k < scan.ranges.size(); ++k) {
    const double range = scan.ranges[k];
    const bool seen = std::isfinite(range) && range > 0.02 && range < maximum;
    made.setScanRange(k, static_cast<float>(seen ? range : maximum));
    made.setScanRangeValidity(k, seen);
  }
  return made;
}

void write(const std::vector<Scan>& scans, const std::string& rawlog, const std::string& list) {
  mrpt::io::CFileGZOutputStream file(rawlog);
  auto archive = mrpt::serialization::archiveFrom(file);
  std::ofstream lines(list);
  const double unknown = maximum_of(scans);
  double time = 0;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const Scan& scan = scans[k];
    time = k == 0 ? std::stod(scan.stamp) : std::max(time + 1e-3, std::stod(scan.stamp));
    const auto stamp = mrpt::Clock::fromDouble(time + 1e9);  // a stamp of 0 means none

    mrpt::obs::CActionRobotMovement2D::TMotionModelOptions model;
    model.modelSelection = mrpt::obs::CActionRobotMovement2D::mmGaussian;
    mrpt::obs::CActionRobotMovement2D movement;
    movement.computeFromOdometry(k == 0 ? mrpt::poses::CPose2D() : scan.pose - scans[k - 1].pose,
                                 model);
    movement.timestamp = stamp;
    mrpt::obs::CActionCollection actions;
    actions.insert(movement);

    mrpt::obs::CSensoryFrame frame;
    frame.insert(mrpt::obs::CObservation2DRangeScan::Ptr(new mrpt::obs::CObservation2DRangeScan(
        observation(scan, scan.maximum > 0 ? scan.maximum : unknown, stamp))));
    archive << actions << frame;

    char pose[128];
    std::snprintf(pose, sizeof pose, " %.9f %.9f %.9f\n", scan.pose.x(), scan.pose.y(),
                  scan.pose.phi());
    lines << scan.stamp << pose;
  }
  if (!lines.flush()) throw std::runtime_error(list + " cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 4) throw std::runtime_error("give LOG OUT.rawlog SCANS.txt [FIRST]");
    const std::size_t first =
        argc > 4 ? std::stoul(argv[4]) : std::numeric_limits<std::size_t>::max();
    std::ifstream file;
    if (std::string(argv[1]) != "-") {
      file.open(argv[1]);
      if (!file) throw std::runtime_error(std::string(argv[1]) + " cannot be opened");
    }
    const std::vector<Scan> scans = scans_of(file.is_open() ? file : std::cin, first);
    if (scans.empty()) throw std::runtime_error("no FLASER or ROBOTLASER1 line in the log");
    write(scans, argv[2], argv[3]);
    std::cerr << scans.size() << " scans\n";
  } catch (const std::exception& e) {
    std::cerr << "carmen_to_rawlog: " << e.what() << '\n';
    return 1;
  }
}
