#include "carmen_log.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "plumb/data/io/file_text.hpp"

namespace plumb::source_carmen {
namespace {

enum class Kind { flaser, robot_laser, raw_laser, odometry, other };
enum class Status { whole, cut, not_a_number };

/// A message: its words behind the first one.
struct Message {
  std::string_view words;
  std::size_t line;
};

/// Takes words off a message; remembers the first thing that went wrong.
class Words {
 public:
  explicit Words(std::string_view words) : rest_(words) {}

  double number() {
    const double value = any_number();
    if (std::isnan(value) && status == Status::whole) status = Status::not_a_number;
    return value;
  }
  double finite() {
    const double value = number();
    if (std::isinf(value) && status == Status::whole) status = Status::not_a_number;
    return value;
  }
  /// NaN and infinity are numbers here.
  double any_number() {
    double value = std::nan("");
    const auto word = next();
    if (status == Status::whole && !io::to_number(word, value)) status = Status::not_a_number;
    return value;
  }
  std::size_t count() {
    std::uint64_t n = 0;
    const auto word = next();
    if (status == Status::whole && !io::to_number(word, n)) status = Status::not_a_number;
    // Each value takes two characters at least.
    if (n > rest_.size() / 2 + 1) status = Status::cut, n = 0;
    return n;
  }
  PlanarPose pose() {
    const double x = finite(), y = finite();
    return {x, y, finite()};
  }
  void skip(std::size_t n) {
    while (n-- > 0) next();
  }
  /// stamp host logger_stamp, and nothing behind them.
  double stamp() {
    const double value = finite();
    skip(1);
    if (status == Status::whole && io::next_word(rest_).empty()) status = Status::cut;
    if (status == Status::whole && !io::next_word(rest_).empty()) status = Status::cut;
    return value;
  }
  Status status = Status::whole;

 private:
  std::string_view next() {
    const auto word = io::next_word(rest_);
    if (word.empty() && status == Status::whole) status = Status::cut;
    return word;
  }
  std::string_view rest_;
};

/// The scan, and whether it is whole.
struct Parsed {
  LaserScan scan;
  Status status = Status::whole;
};

void take_ranges(Words& words, LaserScan& scan) {
  const std::size_t n = words.count();
  scan.ranges.reserve(n);
  for (std::size_t k = 0; k < n && words.status == Status::whole; ++k)
    scan.ranges.push_back(static_cast<float>(words.any_number()));
}

Parsed parse_scan(Kind kind, std::string_view message) {
  Words words(message);
  Parsed parsed;
  LaserScan& scan = parsed.scan;
  if (kind != Kind::flaser) {
    words.skip(1);
    scan.start = words.finite();
    words.skip(1);
    scan.step = words.finite();
    scan.maximum = words.number();
    words.skip(2);
  }
  take_ranges(words, scan);
  if (kind != Kind::flaser) words.skip(words.count());
  if (kind != Kind::raw_laser) {
    scan.laser = words.pose();
    scan.robot = words.pose();
  }
  if (kind == Kind::robot_laser) words.skip(5);
  scan.stamp = words.stamp();
  if (words.status == Status::whole && scan.ranges.empty()) words.status = Status::cut;
  parsed.status = words.status;
  return parsed;
}

struct Odometry {
  std::size_t line;
  double stamp;
  PlanarPose pose;
};

/// All messages of a log, by kind.
struct Sorted {
  std::array<std::vector<Message>, 5> of;
  std::size_t second_laser = 0, no_message = 0;
  double front_laser_offset = 0;
  std::vector<Message>& operator[](Kind kind) { return of[static_cast<std::size_t>(kind)]; }
};

/// CARMEN's messages have names in capitals; blank lines and comments (#) are none and wanted.
bool is_message(std::string_view name) {
  if (name.empty() || name.front() == '#') return true;
  return std::all_of(
             name.begin(), name.end(),
             [](unsigned char c) { return std::isupper(c) || std::isdigit(c) || c == '_'; }) &&
         std::isupper(static_cast<unsigned char>(name.front()));
}

Sorted sorted(std::string_view text) {
  Sorted result;
  io::Lines lines(text);
  for (std::string_view line; lines.next(line);) {
    const auto name = io::next_word(line);
    const auto add = [&](Kind kind) { result[kind].push_back({line, lines.number()}); };
    if (name == "ODOM")
      add(Kind::odometry);
    else if (name == "FLASER")
      add(Kind::flaser);
    else if (name == "ROBOTLASER1")
      add(Kind::robot_laser);
    else if (name == "RAWLASER1")
      add(Kind::raw_laser);
    else if (name == "RLASER" || name == "ROBOTLASER2" || name == "RAWLASER2")
      ++result.second_laser;
    else if (name == "PARAM" && io::next_word(line) == "robot_frontlaser_offset") {
      double offset = 0;
      if (io::to_number(io::next_word(line), offset) && std::isfinite(offset))
        result.front_laser_offset = offset;
    } else if (!is_message(name)) {
      ++result.no_message;
    }
  }
  return result;
}

/// Poses of scans without one: between the ODOM lines before and after them in the file.
void place_by_odometry(std::vector<LaserScan>& scans, const std::vector<std::size_t>& lines,
                       const std::vector<Message>& messages) {
  std::vector<Odometry> odometry;
  for (const Message& message : messages) {
    Words words(message.words);
    Odometry o{message.line, 0, words.pose()};
    words.skip(3);
    o.stamp = words.stamp();
    if (words.status == Status::whole) odometry.push_back(o);
  }
  if (odometry.empty()) return;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const auto after = std::ranges::lower_bound(odometry, lines[k], {}, &Odometry::line);
    const Odometry& b = after == odometry.end() ? odometry.back() : *after;
    const Odometry& a = after == odometry.begin() ? b : *(after - 1);
    const double between = b.stamp - a.stamp;
    const double s = between > 0 ? std::clamp((scans[k].stamp - a.stamp) / between, 0.0, 1.0) : 0.0;
    const double turn = std::remainder(b.pose.yaw - a.pose.yaw, 2 * M_PI);
    scans[k].robot = PlanarPose{a.pose.x + s * (b.pose.x - a.pose.x),
                                a.pose.y + s * (b.pose.y - a.pose.y), a.pose.yaw + s * turn};
  }
}

}  // namespace

CarmenLog parse_carmen(const std::filesystem::path& file, std::string_view text,
                       const parallel::Loop& parallel) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    io::refuse(file, "is empty: give a CARMEN log with FLASER or ROBOTLASER1 lines");
  Sorted messages = sorted(text);
  Kind kind = Kind::flaser;
  if (messages[kind].empty()) kind = Kind::robot_laser;
  if (messages[kind].empty()) kind = Kind::raw_laser;
  const auto& lines = messages[kind];
  if (lines.empty())
    io::refuse(file, "has no laser scan: expected a CARMEN log with FLASER or ROBOTLASER1 lines" +
                         std::string(messages.second_laser ? " (it has a rear laser only)" : ""));

  CarmenLog log;
  log.odometry_lines = messages[Kind::odometry].size();
  log.second_laser = messages.second_laser, log.no_message = messages.no_message;
  log.front_laser_offset = messages.front_laser_offset;
  for (const Kind other : {Kind::robot_laser, Kind::raw_laser})
    if (other != kind) log.repeated += messages[other].size();

  std::vector<Parsed> parsed(lines.size());
  constexpr std::size_t block = 64;
  parallel((lines.size() + block - 1) / block, [&](std::size_t b) {
    for (std::size_t k = b * block; k < std::min(lines.size(), (b + 1) * block); ++k)
      parsed[k] = parse_scan(kind, lines[k].words);
  });
  std::vector<std::size_t> line_of;
  log.scans.reserve(parsed.size());
  for (std::size_t k = 0; k < parsed.size(); ++k) {
    if (parsed[k].status == Status::whole) {
      log.scans.push_back(std::move(parsed[k].scan));
      line_of.push_back(lines[k].line);
      continue;
    }
    ++(parsed[k].status == Status::cut ? log.cut : log.not_numbers);
    if (log.first_damaged == 0) log.first_damaged = lines[k].line;
  }
  if (log.scans.empty())
    io::refuse(file, log.first_damaged,
               "all " + std::to_string(lines.size()) +
                   " laser messages are damaged, this one first: the number of ranges or of the "
                   "words behind them is wrong");
  if (kind == Kind::raw_laser) place_by_odometry(log.scans, line_of, messages[Kind::odometry]);
  return log;
}

}  // namespace plumb::source_carmen
