#pragma once
/// Pose graphs in the text format of g2o.

#include <filesystem>

#include "plumb/slam/graph.hpp"

namespace plumb::source_g2o {

/// A graph and where its vertices start.
struct G2oGraph {
  Constraints constraints;
  Poses poses;  ///< by our index: constraints.ids[k] is the file's number of vertex k
};

/// Reads VERTEX_SE3:QUAT and EDGE_SE3:QUAT, or VERTEX_SE2 and EDGE_SE2 (`planar`), and FIX.
/// Vertices keep the order of their numbers, which may have gaps; an edge may stand before its
/// vertices. An edge j -> i with i < j stays as it is written.
///
/// Information is that of e = (t, q.vec) of T_i_j^-1 T_i^-1 T_j, q.w >= 0, as EDGE_SE3:QUAT has it.
/// An EDGE_SE2 has that of the angle, which is twice q.vec: its last row and column are multiplied
/// by 2 each, and what a plane does not observe is 0. A fixed vertex becomes an absolute constraint
/// of information 1e12.
///
/// Throws Error with file and line: cannot be opened, an unknown word, another number of numbers, a
/// quaternion of norm 0, a vertex given twice, an edge or FIX of an unknown vertex, an edge from a
/// vertex to itself, SE(2) and SE(3) mixed, no vertex.
G2oGraph read_g2o(const std::filesystem::path& file);

}  // namespace plumb::source_g2o
