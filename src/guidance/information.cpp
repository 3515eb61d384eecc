#include "tartan_calib/guidance/information.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace tartan_calib::guidance {
namespace {

// Stdevs that hardly any rig exceeds: [m], [rad], share of the value, share of the image's width, as it is.
constexpr double kTranslationStdev_m = 1.0;
constexpr double kRotationStdev_rad = 1.0;
constexpr double kFocalStdev_ratio = 0.5;
constexpr double kCentreStdev_ratio = 0.2;
constexpr double kShapeStdev = 1.0;

/// log2 of the determinant of a positive definite matrix.
double log2Determinant(const Eigen::MatrixXd& matrix) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(matrix);
  return 2.0 * cholesky.matrixLLT().diagonal().array().log().sum() / std::log(2.0);
}

}  // namespace

Eigen::MatrixXd priorInformation(const calibration::Rig& rig) {
  constexpr Eigen::Index kPoseSize = 6;
  constexpr Eigen::Index kNumFocals = 2;
  const auto num_baselines = static_cast<Eigen::Index>(rig.cameras.size()) - 1;
  Eigen::VectorXd stdevs(kPoseSize * num_baselines);
  for (Eigen::Index i = 0; i < num_baselines; ++i) {
    stdevs.segment<kPoseSize>(kPoseSize * i) << Eigen::Vector3d::Constant(kTranslationStdev_m),
        Eigen::Vector3d::Constant(kRotationStdev_rad);
  }
  for (const calibration::RigCamera& rig_camera : rig.cameras) {
    const camera::Camera& camera = rig_camera.camera;
    const Eigen::VectorXd parameters = camera::parameters(camera.model);
    const Eigen::Index focal = camera::focalIndex(camera.model);
    Eigen::VectorXd own = Eigen::VectorXd::Constant(parameters.size(), kShapeStdev);
    own.segment<kNumFocals>(focal) = kFocalStdev_ratio * parameters.segment<kNumFocals>(focal);
    own.segment<kNumFocals>(focal + kNumFocals).setConstant(kCentreStdev_ratio * camera.width);
    const Eigen::Index at = stdevs.size();
    stdevs.conservativeResize(at + own.size());
    stdevs.tail(own.size()) = own;
  }
  return stdevs.cwiseAbs2().cwiseInverse().asDiagonal();
}

double gainBits(const Eigen::MatrixXd& known, const Eigen::MatrixXd& added) {
  return 0.5 * (log2Determinant(known + added) - log2Determinant(known));
}

}  // namespace tartan_calib::guidance
