#pragma once
/// A map of occupied cells that any number of points can be added to, in little memory.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "plumb/data/file_bytes.hpp"
#include "plumb/slam/cloud.hpp"
#include "plumb/slam/geometry/pose.hpp"
#include "shared/parallel/loop.hpp"
#include "tile.hpp"

namespace plumb::write_map {

/// Cells in tiles. Where no point has fallen for a while a tile is closed, and opened again should
/// one come: what is open is what the sensor sees at present, however long the path. Closed tiles
/// wait in a temporary file once they are many. What is written depends on the points in each cell
/// and their frames' order alone.
class VoxelMap {
 public:
  /// Cells of edge length `voxel_size` [m], counted from `origin` [m, world]. Closed tiles take
  /// `memory` [bytes] before they go to disk.
  VoxelMap(double voxel_size, const Eigen::Vector3d& origin,
           std::size_t memory = std::size_t{32} << 20)
      : leaf_(voxel_size), origin_(origin), memory_(memory) {}

  /// The cells of one frame, tile by tile.
  struct FrameCells {
    struct Part {
      std::uint64_t tile;
      std::uint32_t first, end;  ///< of the cells
    };
    std::vector<Cell> cells;
    std::vector<Part> parts;
    std::uint64_t too_far = 0;  ///< points more than a million cells from the origin, left out
  };
  /// The cells of a cloud under its pose. Safe from several threads.
  FrameCells cells_of(const Cloud& cloud, const Pose& T_world_cloud) const;

  /// Adds frames in their order, tiles in parallel; then closes the tiles that none of the last
  /// `idle` frames has met.
  void add(std::span<const FrameCells> frames, const parallel::Loop& parallel,
           std::size_t idle = 32);

  std::size_t size() const;  ///< cells
  std::size_t open() const;  ///< cells of tiles that are open
  /// Appends the mean of each cell, relative to the origin [m], as three float32 a point, by tile
  /// and place. Frees the cells as it goes.
  void write(FileBytes& bytes);

 private:
  struct Entry {
    Tile tile;
    std::uint64_t last = 0;  ///< frame that met it
  };
  void sink(std::span<Entry* const> closed, const parallel::Loop& parallel);
  double leaf_;
  Eigen::Vector3d origin_;
  std::size_t memory_, packed_ = 0;           ///< [bytes]: what closed tiles may take, and take
  std::unique_ptr<io::ScratchFile> scratch_;  ///< of the closed tiles, once they were too much
  std::unordered_map<std::uint64_t, Entry> tiles_;
  std::vector<Entry*> open_;  ///< tiles that are not closed
  std::uint64_t frames_ = 0;
};

}  // namespace plumb::write_map
