#include "tartan_calib/geometry/linear_solve.h"

#include <Eigen/Cholesky>

namespace tartan_calib::geometry {

Vector6d solveTwist(const Matrix6d& H, const Vector6d& b) { return H.ldlt().solve(b); }

Eigen::VectorXd solveSymmetric(const Eigen::MatrixXd& H, const Eigen::VectorXd& b) { return H.ldlt().solve(b); }

Eigen::MatrixXd solveSymmetric(const Eigen::MatrixXd& H, const Eigen::MatrixXd& B) { return H.ldlt().solve(B); }

}  // namespace tartan_calib::geometry
