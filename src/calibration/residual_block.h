#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "observations.h"
#include "robust_loss.h"
#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::calibration {

/// The board as the solve bends it.
class WarpedBoard {
 public:
  explicit WarpedBoard(const std::vector<Eigen::Vector3d>& flat_points);

  void bend(const Eigen::Vector2d& warp_m);

  const Eigen::Vector3d& point(int corner_id) const { return points_[static_cast<std::size_t>(corner_id)]; }

  /// d(z) / d(warp) = [1 - x^2, 1 - y^2] with x, y in [-1, 1] over the board.
  const Eigen::Vector2d& shape(int corner_id) const { return shapes_[static_cast<std::size_t>(corner_id)]; }

  const std::vector<Eigen::Vector3d>& points() const { return points_; }

 private:
  std::vector<Eigen::Vector3d> flat_points_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector2d> shapes_;
};

/// The corners of one camera in one view, and everything that predicts them.
struct ResidualBlock {
  const CameraMeasurements& measurements;
  const WarpedBoard& board;
  const camera::Camera& camera;
  geometry::Rigid3 T_cam_target;
  RobustLoss loss;
};

/// Sum of the costs of the used corners. A corner without an image costs what a residual as long as the image's diagonal
/// would, so that no step gains by pushing corners out of the model's domain.
double blockCost(const ResidualBlock& block);

/// What a camera's images determine besides poses and parameters.
struct LocalUnknowns {
  bool pupil = false;
  bool warp = false;
};

/// The same with first derivatives by local unknowns: xi of T_cam_target <- exp(xi) T_cam_target (6), the camera's
/// parameters, its pupil's shift (2) and the board's warp (2) if asked for. H = J'J and g = J'r with J and r weighted, r =
/// predicted - measured.
struct LocalTerms {
  double cost = 0.0;
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
};

LocalTerms linearizeBlock(const ResidualBlock& block, const LocalUnknowns& unknowns);

/// Measured minus predicted position of every corner, used or not; empty where the model gives it no image.
std::vector<std::optional<Eigen::Vector2d>> blockErrors(const ResidualBlock& block);

}  // namespace tartan_calib::calibration
