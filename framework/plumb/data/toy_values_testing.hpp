#pragma once
/// For tests of what knows no SLAM: values like the real ones, with places on a line for content.
/// toy_testing.hpp makes types of them.

#include <cstdint>
#include <string>
#include <vector>

#include "plumb/data/number.hpp"

namespace plumb::toy {

/// One point at x, seen `index`-th.
struct Frame {
  std::uint32_t index = 0;
  float x = 0;
};

/// Frames first .. end-1 make a segment.
struct FrameRange {
  std::uint32_t first = 0, end = 0;
  std::size_t size() const { return end - first; }
};

/// Points, and of each its frame's place in the range.
struct Segment {
  FrameRange range;
  std::vector<float> points;
  std::vector<std::uint16_t> frame;
};

struct Features {
  std::vector<float> values;
};

/// Two segments, i < j.
struct Edge {
  std::uint32_t i = 0, j = 0;
};

/// Ordered by (i, j), each pair once.
struct Edges {
  std::uint32_t segments = 0;  ///< how many there are
  std::vector<Edge> list;
};

/// Pairs of points of one edge; `weight` has one entry a pair or none.
struct Matches {
  std::vector<float> p, q, weight;
};

struct Registration {
  double shift = 0;
};

/// Where each segment is.
struct Poses {
  std::vector<double> places;
};

/// Where each frame is.
struct Trajectory {
  std::vector<double> places;
};

struct Metrics {
  std::vector<Number> numbers;

  Metrics& add(std::string name, double value, std::string unit) {
    numbers.push_back({std::move(name), value, std::move(unit)});
    return *this;
  }
};

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Frame>
void fields(Archive& a, T& f) { a(f.index, f.x); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, FrameRange>
void fields(Archive& a, T& r) { a(r.first, r.end); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Segment>
void fields(Archive& a, T& s) { a(s.range, s.points, s.frame); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Features>
void fields(Archive& a, T& f) { a(f.values); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Edge>
void fields(Archive& a, T& e) { a(e.i, e.j); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Edges>
void fields(Archive& a, T& e) { a(e.segments, e.list); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Matches>
void fields(Archive& a, T& m) { a(m.p, m.q, m.weight); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Registration>
void fields(Archive& a, T& r) { a(r.shift); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Poses>
void fields(Archive& a, T& p) { a(p.places); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Trajectory>
void fields(Archive& a, T& t) { a(t.places); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Metrics>
void fields(Archive& a, T& m) { a(m.numbers); }

}  // namespace plumb::toy
