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

template <class Model>
double costOf(const Model& model, const ResidualBlock& block) {
  double cost = 0.0;
  const camera::ShiftedModel<Model> camera{model, block.camera.pupil};
  const Eigen::Matrix3d R = block.T_cam_target.rotation.toRotationMatrix();
  for (const Measurement& corner : block.measurements.corners) {
    if (corner.state != CornerState::kUsed) {
      continue;
    }
    const Eigen::Vector3d p_cam = R * block.board.point(corner.corner_id) + block.T_cam_target.translation;
    Eigen::Vector2d px;
    if (camera.project(p_cam, px)) {
      cost += 0.5 * block.loss.rho((corner.sqrt_information * (px - corner.px)).squaredNorm());
    } else {
      cost += unprojectableCost(block, corner);
    }
  }
  return cost;
}

/// The image of a corner and how it moves.
template <class Model>
struct Projection {
  Eigen::Vector2d px;
  camera::Matrix23d J_px_pcam;
  typename Model::ParameterJacobian J_px_parameters;
  Eigen::Matrix<double, 2, kPupilSize> J_px_pupil;
};

/// Sums A'A over rows of A that come in one corner at a time. Plain loops over two corners at once: several times faster
/// than rank-two updates, and twice as fast as a general matrix product at this size.
template <int kCols>
class GramSum {
 public:
  static constexpr int kPaddedCols = (kCols + 3) / 4 * 4;

  /// One corner's rows; columns from kCols on stay zero.
  using Rows = Eigen::Matrix<double, 2, kPaddedCols, Eigen::RowMajor>;

  /// Takes weight * rows.
  void add(const Eigen::Matrix2d& weight, const Rows& rows) {
    double* const u = rows_.data() + filled_ * kPaddedCols;
    double* const v = u + kPaddedCols;
    for (int col = 0; col < kPaddedCols; ++col) {
      u[col] = weight(0, 0) * rows(0, col) + weight(0, 1) * rows(1, col);
      v[col] = weight(1, 0) * rows(0, col) + weight(1, 1) * rows(1, col);
    }
    filled_ += 2;
    if (filled_ == kRows) {
      flush();
    }
  }

  /// Lower triangle.
  const auto& finish() {
    flush();
    return sum_;
  }

 private:
  static constexpr int kRows = 4;

  void flush() {
    const double* const a = rows_.data();
    const double* const b = a + kPaddedCols;
    const double* const c = b + kPaddedCols;
    const double* const d = c + kPaddedCols;
    for (int col = 0; col < kPaddedCols; ++col) {
      double* const sum = sum_.data() + col * kPaddedCols;
      for (int row = col / 4 * 4; row < kPaddedCols; ++row) {
        sum[row] += (a[col] * a[row] + b[col] * b[row]) + (c[col] * c[row] + d[col] * d[row]);
      }
    }
    rows_.setZero();
    filled_ = 0;
  }

  Eigen::Matrix<double, kRows, kPaddedCols, Eigen::RowMajor> rows_ = decltype(rows_)::Zero();
  Eigen::Matrix<double, kPaddedCols, kPaddedCols> sum_ = decltype(sum_)::Zero();
  int filled_ = 0;
};

/// Projects through the pupil, with all derivatives. The pupil's are computed where it is unknown.
template <int kPupil, class Model>
bool projectCorner(const Model& model, const camera::PupilShift& pupil, const Eigen::Vector3d& p_cam,
                   Projection<Model>& out) {
  if (kPupil == 0 && pupil.isZero()) {
    return model.project(p_cam, out.px, &out.J_px_pcam, &out.J_px_parameters);
  }
  Eigen::Matrix3d J_lens_cam;
  camera::PupilShift::Jacobian J_lens_pupil;
  if (!model.project(pupil.apply(p_cam, &J_lens_cam, &J_lens_pupil), out.px, &out.J_px_pcam, &out.J_px_parameters)) {
    return false;
  }
  out.J_px_pupil = out.J_px_pcam * J_lens_pupil;
  out.J_px_pcam *= J_lens_cam;
  return true;
}

template <class Model, int kPupil, int kWarp>
LocalTerms linearize(const Model& model, const ResidualBlock& block) {
  constexpr int kParameters = Model::kNumParameters;
  constexpr int kUnknowns = kPoseSize + kParameters + kPupil + kWarp;
  using Gram = GramSum<kUnknowns + 1>;
  Gram gram;
  typename Gram::Rows rows = Gram::Rows::Zero();
  double cost = 0.0;
  Projection<Model> projection;

  const Eigen::Matrix3d R = block.T_cam_target.rotation.toRotationMatrix();
  for (const Measurement& corner : block.measurements.corners) {
    if (corner.state != CornerState::kUsed) {
      continue;
    }
    const Eigen::Vector3d p_cam = R * block.board.point(corner.corner_id) + block.T_cam_target.translation;
    if (!projectCorner<kPupil>(model, block.camera.pupil, p_cam, projection)) {
      cost += unprojectableCost(block, corner);
      continue;
    }
    const Eigen::Vector2d error = projection.px - corner.px;
    const camera::Matrix23d& J_px_pcam = projection.J_px_pcam;
    const double s = (corner.sqrt_information * error).squaredNorm();
    cost += 0.5 * block.loss.rho(s);
    // d(p_cam) = rho + phi x p_cam, so that a row j of J_px_pcam gives j (phi x p) = phi (p x j).
    rows.template leftCols<3>() = J_px_pcam;
    rows.template block<1, 3>(0, 3) = p_cam.cross(J_px_pcam.row(0).transpose()).transpose();
    rows.template block<1, 3>(1, 3) = p_cam.cross(J_px_pcam.row(1).transpose()).transpose();
    rows.template middleCols<kParameters>(kPoseSize) = projection.J_px_parameters;
    if constexpr (kPupil > 0) {
      rows.template middleCols<kPupil>(kPoseSize + kParameters) = projection.J_px_pupil;
    }
    if constexpr (kWarp > 0) {
      rows.template middleCols<kWarp>(kPoseSize + kParameters + kPupil) =
          (J_px_pcam * R.col(2)) * block.board.shape(corner.corner_id).transpose();
    }
    rows.col(kUnknowns) = error;
    gram.add(std::sqrt(block.loss.weight(s)) * corner.sqrt_information, rows);
  }
  const auto& sum = gram.finish();
  const Eigen::MatrixXd H = sum.template topLeftCorner<kUnknowns, kUnknowns>().template selfadjointView<Eigen::Lower>();
  return {cost, H, sum.template block<1, kUnknowns>(kUnknowns, 0).transpose()};
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
  return std::visit([&block](const auto& model) { return costOf(model, block); }, block.camera.model);
}

LocalTerms linearizeBlock(const ResidualBlock& block, const LocalUnknowns& unknowns) {
  return std::visit(
      [&](const auto& model) {
        using Model = std::decay_t<decltype(model)>;
        if (unknowns.pupil) {
          return unknowns.warp ? linearize<Model, kPupilSize, kWarpSize>(model, block)
                               : linearize<Model, kPupilSize, 0>(model, block);
        }
        return unknowns.warp ? linearize<Model, 0, kWarpSize>(model, block) : linearize<Model, 0, 0>(model, block);
      },
      block.camera.model);
}

std::vector<std::optional<Eigen::Vector2d>> blockErrors(const ResidualBlock& block) {
  std::vector<std::optional<Eigen::Vector2d>> errors_px;
  errors_px.reserve(block.measurements.corners.size());
  std::visit(
      [&](const auto& model) {
        const camera::ShiftedModel<std::decay_t<decltype(model)>> camera{model, block.camera.pupil};
        for (const Measurement& corner : block.measurements.corners) {
          Eigen::Vector2d px;
          const bool is_projectable = camera.project(block.T_cam_target * block.board.point(corner.corner_id), px);
          errors_px.push_back(is_projectable ? std::optional<Eigen::Vector2d>(corner.px - px) : std::nullopt);
        }
      },
      block.camera.model);
  return errors_px;
}

}  // namespace tartan_calib::calibration
