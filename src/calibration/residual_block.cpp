#include "residual_block.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "tartan_calib/calibration/board_bend.h"

namespace tartan_calib::calibration {
namespace {

constexpr int kPoseSize = 6;
constexpr int kPupilSize = camera::PupilShift::kNumParameters;
constexpr int kWarpSize = 2;

/// What one corner costs when the model gives it no image.
double unprojectableCost(const ResidualBlock& block, const Measurement& corner) {
  const double diagonal_px = std::hypot(block.camera.width, block.camera.height);
  const double s = diagonal_px * diagonal_px * corner.sqrt_information.squaredNorm();
  return 0.5 * block.loss.rho(s);
}

/// Sums A'A over rows of A that come in one corner at a time. Plain loops over two corners at once: several times faster
/// than rank-two updates, and twice as fast as a general matrix product at this size.
class GramSum {
 public:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  explicit GramSum(int num_cols)
      : padded_cols_((num_cols + kPack - 1) / kPack * kPack),
        rows_(Rows::Zero(kRows, padded_cols_)),
        sum_(Eigen::MatrixXd::Zero(padded_cols_, padded_cols_)) {}

  /// Room for one corner's rows; the columns beyond those asked for are there for speed.
  Rows corner() const { return Rows::Zero(2, padded_cols_); }

  /// Takes weight * rows.
  void add(const Eigen::Matrix2d& weight, const Rows& rows) {
    double* const u = rows_.data() + filled_ * padded_cols_;
    double* const v = u + padded_cols_;
    const double* const x = rows.data();
    const double* const y = x + padded_cols_;
    for (int col = 0; col < padded_cols_; ++col) {
      u[col] = weight(0, 0) * x[col] + weight(0, 1) * y[col];
      v[col] = weight(1, 0) * x[col] + weight(1, 1) * y[col];
    }
    filled_ += 2;
    if (filled_ == kRows) {
      flush();
    }
  }

  /// Lower triangle.
  const Eigen::MatrixXd& finish() {
    flush();
    return sum_;
  }

 private:
  static constexpr int kRows = 4;
  static constexpr int kPack = 4;
  using Pack = Eigen::Matrix<double, kPack, 1>;

  void flush() {
    const double* const a = rows_.data();
    const double* const b = a + padded_cols_;
    const double* const c = b + padded_cols_;
    const double* const d = c + padded_cols_;
    for (int col = 0; col < padded_cols_; ++col) {
      double* const sum = sum_.data() + col * padded_cols_;
      for (int row = col / kPack * kPack; row < padded_cols_; row += kPack) {
        Pack::Map(sum + row) += (a[col] * Pack::Map(a + row) + b[col] * Pack::Map(b + row)) +
                                (c[col] * Pack::Map(c + row) + d[col] * Pack::Map(d + row));
      }
    }
    rows_.setZero();
    filled_ = 0;
  }

  int padded_cols_;
  Rows rows_;
  Eigen::MatrixXd sum_;
  int filled_ = 0;
};

/// The image of a corner and how it moves.
struct Projection {
  Eigen::Vector2d px;
  camera::Matrix23d J_px_pcam;
  camera::ParameterJacobian J_px_parameters;
  Eigen::Matrix<double, 2, kPupilSize> J_px_pupil;
};

/// Projects with all derivatives; without those by the pupil where it is known to stay in place.
bool projectCorner(const camera::Camera& camera, bool pupil_moves, const Eigen::Vector3d& p_cam, Projection& out) {
  Eigen::Vector3d p_lens = p_cam;
  Eigen::Matrix3d J_lens_cam;
  camera::PupilShift::Jacobian J_lens_pupil;
  if (pupil_moves) {
    p_lens = camera.pupil.apply(p_cam, &J_lens_cam, &J_lens_pupil);
  }
  const auto px = project(camera.model, p_lens, &out.J_px_pcam, &out.J_px_parameters);
  if (!px) {
    return false;
  }
  out.px = *px;
  if (pupil_moves) {
    out.J_px_pupil = out.J_px_pcam * J_lens_pupil;
    out.J_px_pcam *= J_lens_cam;
  }
  return true;
}

}  // namespace

WarpedBoard::WarpedBoard(const std::vector<Eigen::Vector3d>& flat_points) : flat_points_(flat_points), points_(flat_points) {
  const BoardBend bend(flat_points);
  for (const Eigen::Vector3d& p : flat_points_) {
    shapes_.push_back(bend.at(p.head<2>()));
  }
}

void WarpedBoard::bend(const Eigen::Vector2d& warp_m) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    points_[i].z() = flat_points_[i].z() + shapes_[i].dot(warp_m);
  }
}

double blockCost(const ResidualBlock& block) {
  double cost = 0.0;
  const Eigen::Matrix3d R = block.T_cam_target.rotation.toRotationMatrix();
  for (const Measurement& corner : block.measurements.corners) {
    if (corner.state != CornerState::kUsed) {
      continue;
    }
    const Eigen::Vector3d p_cam = R * block.board.point(corner.corner_id) + block.T_cam_target.translation;
    if (const auto px = project(block.camera, p_cam)) {
      cost += 0.5 * block.loss.rho((corner.sqrt_information * (*px - corner.px)).squaredNorm());
    } else {
      cost += unprojectableCost(block, corner);
    }
  }
  return cost;
}

LocalTerms linearizeBlock(const ResidualBlock& block, const LocalUnknowns& unknowns) {
  const int num_parameters = camera::numParameters(block.camera.model);
  const int pupil_begin = kPoseSize + num_parameters;
  const int warp_begin = pupil_begin + (unknowns.pupil ? kPupilSize : 0);
  const int num_unknowns = warp_begin + (unknowns.warp ? kWarpSize : 0);
  GramSum gram(num_unknowns + 1);
  GramSum::Rows rows = gram.corner();
  double cost = 0.0;
  Projection projection;
  const bool pupil_moves = unknowns.pupil || !block.camera.pupil.isZero();

  const Eigen::Matrix3d R = block.T_cam_target.rotation.toRotationMatrix();
  for (const Measurement& corner : block.measurements.corners) {
    if (corner.state != CornerState::kUsed) {
      continue;
    }
    const Eigen::Vector3d p_cam = R * block.board.point(corner.corner_id) + block.T_cam_target.translation;
    if (!projectCorner(block.camera, pupil_moves, p_cam, projection)) {
      cost += unprojectableCost(block, corner);
      continue;
    }
    const Eigen::Vector2d error = projection.px - corner.px;
    const camera::Matrix23d& J_px_pcam = projection.J_px_pcam;
    const double s = (corner.sqrt_information * error).squaredNorm();
    cost += 0.5 * block.loss.rho(s);
    // d(p_cam) = rho + phi x p_cam, so that a row j of J_px_pcam gives j (phi x p) = phi (p x j).
    rows.leftCols<3>() = J_px_pcam;
    rows.block<1, 3>(0, 3) = p_cam.cross(J_px_pcam.row(0).transpose()).transpose();
    rows.block<1, 3>(1, 3) = p_cam.cross(J_px_pcam.row(1).transpose()).transpose();
    rows.middleCols(kPoseSize, num_parameters) = projection.J_px_parameters;
    if (unknowns.pupil) {
      rows.middleCols<kPupilSize>(pupil_begin) = projection.J_px_pupil;
    }
    if (unknowns.warp) {
      rows.middleCols<kWarpSize>(warp_begin) = (J_px_pcam * R.col(2)) * block.board.shape(corner.corner_id).transpose();
    }
    rows.col(num_unknowns) = error;
    gram.add(std::sqrt(block.loss.weight(s)) * corner.sqrt_information, rows);
  }
  const Eigen::MatrixXd& sum = gram.finish();
  return {cost, sum.topLeftCorner(num_unknowns, num_unknowns).selfadjointView<Eigen::Lower>(),
          sum.row(num_unknowns).head(num_unknowns).transpose()};
}

std::vector<std::optional<Eigen::Vector2d>> blockErrors(const ResidualBlock& block) {
  std::vector<std::optional<Eigen::Vector2d>> errors_px;
  errors_px.reserve(block.measurements.corners.size());
  for (const Measurement& corner : block.measurements.corners) {
    const auto px = project(block.camera, block.T_cam_target * block.board.point(corner.corner_id));
    errors_px.push_back(px ? std::optional<Eigen::Vector2d>(corner.px - *px) : std::nullopt);
  }
  return errors_px;
}

}  // namespace tartan_calib::calibration
