#include "residual_block.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace tartan_calib::calibration {
namespace {

constexpr int kPoseSize = 6;
constexpr int kWarpSize = 2;

/// What one corner costs when the model gives it no image.
double unprojectableCost(const ResidualBlock& block, const Measurement& corner) {
  const double diagonal_px = std::hypot(block.camera.width, block.camera.height);
  const double s = diagonal_px * diagonal_px * corner.sqrt_information.squaredNorm();
  return 0.5 * block.loss.rho(s);
}

template <class Model>
double costOf(const Model& model, const ResidualBlock& block) {
  double cost = 0.0;
  const Eigen::Matrix3d R = block.T_cam_target.rotation.toRotationMatrix();
  for (const Measurement& corner : block.measurements.corners) {
    if (corner.state != CornerState::kUsed) {
      continue;
    }
    const Eigen::Vector3d p_cam = R * block.board.point(corner.corner_id) + block.T_cam_target.translation;
    Eigen::Vector2d px;
    if (model.project(p_cam, px)) {
      cost += 0.5 * block.loss.rho((corner.sqrt_information * (px - corner.px)).squaredNorm());
    } else {
      cost += unprojectableCost(block, corner);
    }
  }
  return cost;
}

/// Sums A'A over rows handed in one corner at a time. Rows are collected first: the product of a tall block is several
/// times faster than rank-two updates.
template <int kCols>
class GramSum {
 public:
  using Row = Eigen::Matrix<double, 2, kCols>;

  void add(const Row& rows) {
    rows_.template middleRows<2>(filled_) = rows;
    filled_ += 2;
    if (filled_ == kRows) {
      flush();
    }
  }

  const Eigen::Matrix<double, kCols, kCols>& finish() {
    flush();
    return sum_;
  }

 private:
  static constexpr int kRows = 64;  ///< with 18 columns at most, the rows stay in the first-level cache

  void flush() {
    const auto rows = rows_.topRows(filled_);
    sum_.noalias() += rows.transpose() * rows;
    filled_ = 0;
  }

  Eigen::Matrix<double, kRows, kCols> rows_;
  Eigen::Matrix<double, kCols, kCols> sum_ = Eigen::Matrix<double, kCols, kCols>::Zero();
  Eigen::Index filled_ = 0;
};

template <class Model>
LocalTerms linearize(const Model& model, const ResidualBlock& block) {
  constexpr int kParameters = Model::kNumParameters;
  constexpr int kUnknowns = kPoseSize + kParameters + kWarpSize;
  GramSum<kUnknowns + 1> gram;
  typename GramSum<kUnknowns + 1>::Row rows;
  double cost = 0.0;

  const Eigen::Matrix3d R = block.T_cam_target.rotation.toRotationMatrix();
  for (const Measurement& corner : block.measurements.corners) {
    if (corner.state != CornerState::kUsed) {
      continue;
    }
    const Eigen::Vector3d p_cam = R * block.board.point(corner.corner_id) + block.T_cam_target.translation;
    Eigen::Vector2d px;
    camera::Matrix23d J_px_pcam;
    typename Model::ParameterJacobian J_px_parameters;
    if (!model.project(p_cam, px, &J_px_pcam, &J_px_parameters)) {
      cost += unprojectableCost(block, corner);
      continue;
    }
    const Eigen::Vector2d error = px - corner.px;
    const double s = (corner.sqrt_information * error).squaredNorm();
    cost += 0.5 * block.loss.rho(s);
    // d(p_cam) = rho + phi x p_cam, so that a row j of J_px_pcam gives j phi x p = phi . (p x j).
    rows.template leftCols<3>() = J_px_pcam;
    rows.template block<1, 3>(0, 3) = p_cam.cross(J_px_pcam.row(0).transpose()).transpose();
    rows.template block<1, 3>(1, 3) = p_cam.cross(J_px_pcam.row(1).transpose()).transpose();
    rows.template middleCols<kParameters>(kPoseSize) = J_px_parameters;
    rows.template middleCols<kWarpSize>(kPoseSize + kParameters) =
        (J_px_pcam * R.col(2)) * block.board.shape(corner.corner_id).transpose();
    rows.col(kUnknowns) = error;
    const Eigen::Matrix2d weight = std::sqrt(block.loss.weight(s)) * corner.sqrt_information;
    rows = weight * rows;
    gram.add(rows);
  }
  const auto& sum = gram.finish();
  return {cost, sum.template topLeftCorner<kUnknowns, kUnknowns>(), sum.template topRightCorner<kUnknowns, 1>()};
}

}  // namespace

WarpedBoard::WarpedBoard(const std::vector<Eigen::Vector3d>& flat_points) : flat_points_(flat_points), points_(flat_points) {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  for (const Eigen::Vector3d& p : flat_points_) {
    low = low.min(p.head<2>().array());
    high = high.max(p.head<2>().array());
  }
  for (const Eigen::Vector3d& p : flat_points_) {
    const Eigen::Array2d centred = 2.0 * (p.head<2>().array() - low) / (high - low) - 1.0;
    shapes_.emplace_back(1.0 - centred.square());
  }
}

void WarpedBoard::bend(const Eigen::Vector2d& warp_m) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    points_[i].z() = flat_points_[i].z() + shapes_[i].dot(warp_m);
  }
}

double blockCost(const ResidualBlock& block) {
  return std::visit([&block](const auto& model) { return costOf(model, block); }, block.camera.model);
}

LocalTerms linearizeBlock(const ResidualBlock& block) {
  return std::visit([&block](const auto& model) { return linearize(model, block); }, block.camera.model);
}

}  // namespace tartan_calib::calibration
