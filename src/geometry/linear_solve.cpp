#include "tartan_calib/geometry/linear_solve.h"

#include <Eigen/Cholesky>

namespace tartan_calib::geometry {

Vector6d solveTwist(const Matrix6d& H, const Vector6d& b) { return H.ldlt().solve(b); }

Eigen::VectorXd solveSymmetric(const Eigen::MatrixXd& H, const Eigen::VectorXd& b) { return H.ldlt().solve(b); }

Eigen::MatrixXd solveSymmetric(const Eigen::MatrixXd& H, const Eigen::MatrixXd& B) { return H.ldlt().solve(B); }

std::optional<Eigen::MatrixXd> solveDefinite(const Eigen::MatrixXd& H, const Eigen::MatrixXd& B, double min_condition) {
  const auto decomposition = H.ldlt();
  // rcond() does not count pivots that are exactly 0.
  if (!(decomposition.vectorD().array() > 0.0).all() || !(decomposition.rcond() > min_condition)) {
    return std::nullopt;
  }
  return decomposition.solve(B);
}

}  // namespace tartan_calib::geometry
