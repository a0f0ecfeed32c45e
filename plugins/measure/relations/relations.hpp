#pragma once
/// Errors of a trajectory against true relative poses between moments. Source: [Kuemmerle2009].

#include <filesystem>
#include <vector>

#include "plumb/slam/trajectory.hpp"

namespace plumb::measure_relations {

/// The true pose at `to` in the coordinates of that at `from`.
struct TrueRelation {
  double from = 0, to = 0;  ///< stamps [s]
  Pose T_from_to;
};

struct RelationsFile {
  std::vector<TrueRelation> relations;
  std::size_t too_short = 0;  ///< lines with fewer than 8 words, left out
};

/// Reads lines `from to x y z roll pitch yaw` [s, m, rad], R = Rz(yaw) Ry(pitch) Rx(roll); words
/// behind these are not read, comments (#) are skipped. Throws Error: cannot be opened, a word that
/// is no number, no relation.
RelationsFile read_relations(const std::filesystem::path& file);

/// The frame whose stamp is nearest to a given one, by value: stamps may step back. Of several as
/// near the first.
class NearestStamp {
 public:
  explicit NearestStamp(const std::vector<double>& stamps);
  std::size_t of(double stamp) const;  ///< there must be a stamp

 private:
  std::vector<std::pair<double, std::size_t>> sorted_;
};

/// Mean and standard deviation (of all, not of a sample).
struct Spread {
  double mean, deviation;
};

struct RelationErrors {
  std::size_t used = 0;                          ///< relations whose two moments have a frame each
  Spread translation, rotation;                  ///< absolute [m], [rad]; NaN for none used
  Spread translation_squared, rotation_squared;  ///< [m^2], [rad^2]
};

/// The error of a relation is the motion T_from_to^-1 (T_i^-1 T_j), i and j the frames nearest to
/// its moments, used where both are at most `tolerance` [s] away; its length and its angle are
/// summed up.
RelationErrors relation_errors(const std::vector<TrueRelation>& relations,
                               const Trajectory& trajectory, double tolerance);

}  // namespace plumb::measure_relations
