#pragma once

#include <Eigen/Core>
#include <optional>

#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::geometry {

// The x of H x = b, H symmetric and positive semidefinite, by LDLT. Functions, not templates: each of Eigen's decompositions
// takes seconds to compile in every file that uses it.

/// Of the six unknowns of a rigid motion.
Vector6d solveTwist(const Matrix6d& H, const Vector6d& b);
Eigen::VectorXd solveSymmetric(const Eigen::MatrixXd& H, const Eigen::VectorXd& b);

/// One column per column of `B`.
Eigen::MatrixXd solveSymmetric(const Eigen::MatrixXd& H, const Eigen::MatrixXd& B);

/// The same; empty where H is not positive definite or its reciprocal condition not above `min_condition`.
std::optional<Eigen::MatrixXd> solveDefinite(const Eigen::MatrixXd& H, const Eigen::MatrixXd& B, double min_condition);

}  // namespace tartan_calib::geometry
