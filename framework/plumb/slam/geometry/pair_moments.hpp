#pragma once
/// The pairs of an edge, summed: a sum of weighted squared residuals over any number of point pairs
/// is an exact quadratic form of the relative pose's matrix, so an edge costs the same for 10 or
/// 10,000 pairs.
///
/// With T = T_j_i = (R, t) and p' = p - centre, a pair's difference d = T p - q is linear in R and
/// in s = T centre:
///   d(T) = d(T0) + (R - R0) p' + (s - s0)
/// so with y = [rows of R - R0 (9); s - s0 (3); 1] every residual is a' y: for points one row a =
/// [e_d (x) p'; e_d; d_d(T0)] per axis d, for planes a = [n (x) p'; n; n'd(T0)]. The sum is y' M y
/// with M = sum w a a'. Taking it about the pairs' centre and about a pose T0 near the solution is
/// what keeps it from cancelling.

#include <Eigen/Core>

#include "plumb/slam/geometry/pose.hpp"

namespace plumb {

using Vector13d = Eigen::Matrix<double, 13, 1>;
using Matrix13d = Eigen::Matrix<double, 13, 13>;

/// The matrix that multiplies as v x ... does.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);

/// What a sum over pairs is taken about: T_j_i and a point in i's coordinates [m], best the mean of
/// the pairs' p.
struct PairReference {
  Pose T_j_i;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();

  /// y of the relative pose (r, t): see the top of the file.
  Vector13d coordinates(const Eigen::Matrix3d& r, const Eigen::Vector3d& t) const;
};

/// Sums of point pairs, by blocks: p' p'', p' d' and so on; 23 numbers.
class PointPairSums {
 public:
  /// `p` is p' = p - centre, `d` the difference T0 p - q [m].
  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& d, double w) {
    const Eigen::Vector4d wp(w * p.x(), w * p.y(), w * p.z(), w);
    pp_.col(0) += wp * p.x();
    pp_.col(1) += wp * p.y();
    pp_.col(2) += wp * p.z();
    pp_.col(3) += wp;
    pd_.col(0) += wp * d.x();
    pd_.col(1) += wp * d.y();
    pd_.col(2) += wp * d.z();
    dd_ += w * d.squaredNorm();
  }
  Matrix13d moments() const;

 private:
  Eigen::Matrix4d pp_ = Eigen::Matrix4d::Zero();  ///< sum w [p'; 1] [p'; 1]'
  Eigen::Matrix<double, 4, 3> pd_ = Eigen::Matrix<double, 4, 3>::Zero();  ///< sum w [p'; 1] d'
  double dd_ = 0;                                                         ///< sum w d'd
};

/// Sums of point-to-plane pairs.
class PlanePairSums {
 public:
  /// `p` is p' = p - centre, `n` the unit normal at q in j's coordinates, `e` the residual n'(T0 p
  /// - q) [m].
  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double e, double w) {
    Eigen::Matrix<double, 12, 1> a;
    for (int d = 0; d < 3; ++d) a.segment<3>(3 * d) = n[d] * p;
    a.tail<3>() = n;
    const Eigen::Matrix<double, 12, 1> wa = w * a;
    for (int c = 0; c < 12; ++c) aa_.col(c) += wa * a[c];
    ae_ += wa * e;
    ee_ += w * e * e;
  }
  Matrix13d moments() const;

 private:
  Eigen::Matrix<double, 12, 12> aa_ = Eigen::Matrix<double, 12, 12>::Zero();
  Eigen::Matrix<double, 12, 1> ae_ = Eigen::Matrix<double, 12, 1>::Zero();
  double ee_ = 0;
};

/// A factor F with M = F'F, so that y'My = |F y|^2 with 13 residuals. M is scaled to a unit
/// diagonal first, which keeps small residuals beside long levers; eigenvalues that rounding made
/// negative count as 0 (M has rank 13 at most, often less).
Matrix13d factor_of(const Matrix13d& moments);

/// A summed edge: residuals F y(T_j_i).
struct PairForm {
  PairReference about;
  Matrix13d factor = Matrix13d::Zero();

  Vector13d residual(const Eigen::Matrix3d& r, const Eigen::Vector3d& t) const;
  /// Derivative of the residual where T_j_i moves to (R exp(w), t + v): columns v, then w.
  Eigen::Matrix<double, 13, 6> jacobian(const Eigen::Matrix3d& r) const;
};

/// The T_j_i with the smallest sum of squares, by Gauss-Newton from the form's reference.
/// Directions that the pairs leave free stay as they are. At most `steps` steps.
Pose fitted(const PairForm& form, int steps = 20);

}  // namespace plumb
