#include "../finite.hpp"
#include "../fuzz.hpp"
#include "carmen_log.hpp"
#include "decompress.hpp"
#include "scan_cloud.hpp"

using namespace plumb;
using namespace plumb::source_carmen;

/// As source.carmen does: a log, packed or not, to scans and to their points.
PLUMB_FUZZ_READER(carmen) {
  const auto file = fuzz::file_of(bytes);
  const std::string text = unpacked(file);
  const CarmenLog log = parse_carmen(file, text, [](std::size_t n, const auto& body) {
    for (std::size_t k = 0; k < n; ++k) body(k);
  });
  const double most = repeated_maximum(log.scans).value_or(80);
  mounting_of(log.scans, log.front_laser_offset);
  for (const LaserScan& scan : log.scans) {
    LeftOut left_out;
    const Cloud cloud = cloud_of(scan, fan_of(scan, std::nullopt), {0.05, most}, &left_out);
    fuzz::require(is_finite(cloud), "points that were read are finite");
    const std::size_t out = left_out.nothing_seen + left_out.too_near + left_out.no_number;
    fuzz::require(cloud.size() + out == scan.ranges.size(),
                  "every reading becomes a point or is counted as left out");
  }
}
