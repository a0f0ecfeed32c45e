#pragma once
/// What the benchmarks run on: segments of a street, as a pipeline for cars makes them.

#include <filesystem>
#include <string>

#include "plumb/data/cloud.hpp"

namespace plumb::bench {

/// Points of a segment of about 17 m of path with a 64-line laser, thinned to `leaf` [m], without
/// normals; `which` is 0, 1, ..., neighbours overlap. From five frames of the real sequence
/// `kitti_street` where that exists, else from a street made of planes and boxes.
Cloud street_segment(unsigned which, double leaf = 0.4);

/// The same with normals (30 nearest within 1 m, turned to the segment's origin).
Cloud street_segment_with_normals(unsigned which, double leaf = 0.4);

/// "kitti_street" or "made street": what street_segment gives here.
std::string scene_name();

}  // namespace plumb::bench
