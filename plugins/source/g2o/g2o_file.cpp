#include "g2o_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "plumb/data/io/file_text.hpp"

namespace plumb::source_g2o {
namespace {

struct Vertex {
  std::uint64_t id;
  std::size_t line;
  Pose pose;
};
struct Measured {
  std::uint64_t from, to;
  std::size_t line;
  RelativePose constraint;
};
struct Fixed {
  std::uint64_t id;
  std::size_t line;
};

/// The symmetric matrix of which `v` is the upper triangle, row by row.
Eigen::MatrixXd symmetric(std::span<const double> v, int rows) {
  Eigen::MatrixXd m(rows, rows);
  std::size_t k = 0;
  for (int a = 0; a < rows; ++a)
    for (int b = a; b < rows; ++b) m(a, b) = m(b, a) = v[k++];
  return m;
}

/// Information of (x, y, angle) as one of (t, q.vec), where q.vec's last entry is half the angle.
Matrix6d from_plane(Eigen::Matrix3d information) {
  information.row(2) *= 2;
  information.col(2) *= 2;
  const int place[] = {0, 1, 5};
  Matrix6d result = Matrix6d::Zero();
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) result(place[a], place[b]) = information(a, b);
  return result;
}

/// The file as it is written; vertices are still known by their numbers.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file) {}

  G2oGraph read() {
    const io::FileBytes bytes(file_);
    io::Lines lines(bytes.view());
    for (std::string_view line; lines.next(line);) {
      line_ = lines.number();
      const std::string_view word = io::next_word(line);
      if (!word.empty() && word.front() != '#') take(word, line);
    }
    return joined();
  }

 private:
  void take(std::string_view word, std::string_view rest) {
    if (word == "VERTEX_SE3:QUAT") {
      const auto id = number(rest, word);
      vertices_.push_back({id, line_, spatial_pose(numbers<7>(rest, word))});
      is_planar(false);
    } else if (word == "VERTEX_SE2") {
      const auto id = number(rest, word);
      vertices_.push_back({id, line_, planar_pose(numbers<3>(rest, word))});
      is_planar(true);
    } else if (word == "EDGE_SE3:QUAT") {
      const auto from = number(rest, word), to = number(rest, word);
      const auto v = numbers<7 + 21>(rest, word);
      edges_.push_back(
          {from,
           to,
           line_,
           {0, 0, spatial_pose(std::span(v).first(7)), symmetric(std::span(v).last(21), 6)}});
      is_planar(false);
    } else if (word == "EDGE_SE2") {
      const auto from = number(rest, word), to = number(rest, word);
      const auto v = numbers<3 + 6>(rest, word);
      edges_.push_back({from,
                        to,
                        line_,
                        {0, 0, planar_pose(std::span(v).first(3)),
                         from_plane(symmetric(std::span(v).last(6), 3))}});
      if (!edges_.back().constraint.information.allFinite()) refuse("the information is too large");
      is_planar(true);
    } else if (word == "FIX") {
      do fixed_.push_back({number(rest, word), line_});
      while (!rest.empty() && rest.find_first_not_of(" \t") != rest.npos);
    } else {
      refuse("unknown word " + io::in_quotes(word) +
             ": known are VERTEX_SE3:QUAT, EDGE_SE3:QUAT, VERTEX_SE2, EDGE_SE2 and FIX");
    }
  }

  std::uint64_t number(std::string_view& rest, std::string_view of) {
    const std::string_view word = io::next_word(rest);
    std::uint64_t value = 0;
    if (!io::to_number(word, value))
      refuse(io::in_quotes(word) + " after " + std::string(of) +
             " is not a vertex number: expected 0, 1, 2 or so");
    return value;
  }
  /// Exactly n finite numbers to the end of the line.
  template <std::size_t n>
  std::array<double, n> numbers(std::string_view rest, std::string_view of) {
    std::array<double, n> values;
    const auto expected =
        std::string(of) + " takes " + std::to_string(n) + " numbers after its vertices: ";
    for (double& value : values) {
      const std::string_view word = io::next_word(rest);
      if (word.empty()) refuse(expected + "there are fewer");
      if (!io::to_number(word, value) || !std::isfinite(value))
        refuse(expected + io::in_quotes(word) + " is none");
    }
    if (!io::next_word(rest).empty()) refuse(expected + "there are more");
    return values;
  }
  Pose spatial_pose(std::span<const double> v) {
    Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    const double norm = q.coeffs().stableNorm();
    if (!(norm > 1e-6))
      refuse("the quaternion has norm 0, so it is not a rotation: no rotation is 0 0 0 1");
    if (!std::isfinite(norm)) refuse("the quaternion is too large: its norm is 1");
    q.coeffs() /= norm;
    return {q, Eigen::Vector3d(v[0], v[1], v[2])};
  }
  /// Of a heading with more turns than a double can tell apart nothing is left.
  Pose planar_pose(std::span<const double> v) {
    if (std::abs(v[2]) > 1e6)
      refuse("the heading is no angle: expected radians, at most a million to either side");
    return {exp_rotation({0, 0, v[2]}), Eigen::Vector3d(v[0], v[1], 0)};
  }
  void is_planar(bool planar) {
    if (known_ && planar != planar_) refuse("SE2 and SE3 stand in one file: keep to one of them");
    known_ = true;
    planar_ = planar;
  }

  /// Vertices by number, edges by index.
  G2oGraph joined() {
    if (vertices_.empty())
      io::refuse(file_, "holds no vertex: expected VERTEX_SE3:QUAT or VERTEX_SE2 lines");
    std::ranges::stable_sort(vertices_, {}, &Vertex::id);
    G2oGraph graph;
    graph.constraints.planar = planar_;
    for (const Vertex& vertex : vertices_) {
      line_ = vertex.line;
      if (!graph.constraints.ids.empty() && graph.constraints.ids.back() == vertex.id)
        refuse("vertex " + std::to_string(vertex.id) + " is given a second time: keep one");
      graph.constraints.ids.push_back(vertex.id);
      graph.poses.T_world_segment.push_back(vertex.pose);
    }
    for (Measured& edge : edges_) {
      line_ = edge.line;
      edge.constraint.i = index_of(edge.from, graph.constraints.ids);
      edge.constraint.j = index_of(edge.to, graph.constraints.ids);
      if (edge.from == edge.to)
        refuse("the edge goes from vertex " + std::to_string(edge.from) + " to itself: remove it");
      graph.constraints.relative.push_back(edge.constraint);
    }
    std::vector<bool> is_fixed(vertices_.size());
    for (const Fixed& fixed : fixed_) {
      line_ = fixed.line;
      const std::uint32_t i = index_of(fixed.id, graph.constraints.ids);
      if (is_fixed[i]) continue;  // one that is fixed twice stays no more firmly
      is_fixed[i] = true;
      graph.constraints.absolute.push_back(
          {i, graph.poses.T_world_segment[i], 1e12 * Matrix6d::Identity()});
    }
    return graph;
  }
  std::uint32_t index_of(std::uint64_t id, const std::vector<std::uint64_t>& ids) {
    const auto at = std::ranges::lower_bound(ids, id);
    if (at == ids.end() || *at != id)
      refuse("vertex " + std::to_string(id) +
             " is unknown: give it a VERTEX line, or remove this one");
    return static_cast<std::uint32_t>(at - ids.begin());
  }
  [[noreturn]] void refuse(const std::string& what) const { io::refuse(file_, line_, what); }

  std::filesystem::path file_;
  std::size_t line_ = 0;
  bool known_ = false, planar_ = false;
  std::vector<Vertex> vertices_;
  std::vector<Measured> edges_;
  std::vector<Fixed> fixed_;
};

}  // namespace

G2oGraph read_g2o(const std::filesystem::path& file) { return Reader(file).read(); }

}  // namespace plumb::source_g2o
