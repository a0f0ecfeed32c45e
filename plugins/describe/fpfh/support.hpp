#pragma once
/// A cloud in the order of cubic cells, so that all points that may lie within a radius of a cell's
/// points are a few runs of consecutive points. For many questions with one radius this beats a
/// tree.

#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::describe_fpfh {

/// The points that may lie within the radius of one cell's points, side by side, filled up to a
/// multiple of `lanes` with points at infinity.
struct Candidates {
  static constexpr std::size_t lanes = 8;
  std::vector<float> x, y, z, nx, ny, nz;
  std::vector<std::uint32_t> place;  ///< in the Support
  std::size_t size = 0;              ///< a multiple of `lanes`
};

/// Points with a finite position and a normal, ordered by cell, then by index.
class Support {
 public:
  struct Cell {
    std::uint64_t key;
    std::uint32_t first, end;  ///< its points
  };

  Support(const Cloud& cloud, double radius);

  std::size_t size() const { return index.size(); }
  const std::vector<Cell>& cells() const { return cells_; }
  /// Ranges of cells with about `points` points each: where each begins, and the end of the last.
  std::vector<std::size_t> blocks(std::size_t points) const;

  std::vector<float> x, y, z, nx, ny, nz;
  std::vector<std::uint32_t> index;  ///< of each point in the cloud

 private:
  friend class CandidateFinder;
  std::vector<Cell> cells_;
  std::uint64_t step_x_ = 0,
                step_y_ = 0;  ///< how a key grows from one cell to the next along x and y
};

/// Collects candidates for one cell after another, in ascending order of cells.
class CandidateFinder {
 public:
  explicit CandidateFinder(const Support& support) : support_(support) {}
  const Candidates& around(const Support::Cell& cell);

 private:
  struct Column {
    std::int64_t offset;     ///< of its middle cell's key
    std::size_t first, end;  ///< cells
  };
  const Support& support_;
  std::vector<Column> columns_;
  Candidates candidates_;
};

}  // namespace plumb::describe_fpfh
