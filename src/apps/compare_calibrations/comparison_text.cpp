#include "compare_calibrations/comparison.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

constexpr double kDegreesPerRadian = 57.29577951308232;
constexpr double kMilli = 1e3;

std::string parametersText(const camera::CameraModel& a, const camera::CameraModel& b) {
  std::string text = "  parameters of both in the camchain's order, and their difference:\n";
  const Eigen::VectorXd first = camera::parameters(a);
  const Eigen::VectorXd second = camera::parameters(b);
  for (Eigen::Index i = 0; i < first.size(); ++i) {
    text += format("  %14.6f%14.6f%+14.6f\n", first[i], second[i], first[i] - second[i]);
  }
  return text;
}

std::string bandsText(const std::vector<DifferenceBand>& bands) {
  std::string text = "  degrees from the axis    pixels  mean px   rms px   max px\n";
  for (const DifferenceBand& band : bands) {
    if (band.num_pixels > 0) {
      text += format("  %9.0f to %3.0f      %10d %8.4f %8.4f %8.4f\n", band.from_rad * kDegreesPerRadian,
                     band.to_rad * kDegreesPerRadian, band.num_pixels, band.mean_px, band.rms_px, band.max_px);
    }
  }
  return text;
}

std::string projectionText(const CameraComparison& camera, const ComparisonRegion& region) {
  const geometry::Rigid3& T_b_a = camera.projection.T_b_a;
  std::string text =
      format("  projection to %.1f degrees%s: differs by %.6f px rms, %.6f px at most, %.6f px on average\n",
             region.max_angle_rad * kDegreesPerRadian, region.recordings.empty() ? "" : ", where there are corners",
             camera.projection.rms_px, camera.projection.max_px, camera.mean_px);
  text += format("  after turning the camera by %.4f mrad", geometry::logRotation(T_b_a.rotation).norm() * kMilli);
  text += region.distance_m ? format(" and moving it by %.4f mm, for points %g m away\n", T_b_a.translation.norm() * kMilli,
                                     *region.distance_m)
                            : std::string(", for points at infinity\n");
  return text + bandsText(camera.bands);
}

std::string pairsText(const std::vector<PairComparison>& pairs) {
  std::string text;
  for (const PairComparison& pair : pairs) {
    const MotionSize& whole = pair.difference;
    const MotionSize& rest = pair.difference_without_frames;
    text += format("cam%d on cam%d: place differs by %.6f mrad and %.6f mm\n", pair.second, pair.first,
                   whole.rotation_rad * kMilli, whole.translation_m * kMilli);
    text += format("  and by %.6f mrad and %.6f mm without what the projections take over\n", rest.rotation_rad * kMilli,
                   rest.translation_m * kMilli);
  }
  return text;
}

}  // namespace

std::string comparisonText(const io::Camchain& a, const io::Camchain& b, const ComparisonRegion& region,
                           const RigComparison& comparison) {
  std::string text;
  for (std::size_t i = 0; i < comparison.cameras.size(); ++i) {
    const camera::CameraModel& first = a.rig.cameras[i].camera.model;
    const camera::CameraModel& second = b.rig.cameras[i].camera.model;
    text += cameraName(i) + ", " + camera::modelName(first) + " and " + camera::modelName(second) + "\n";
    if (first.index() == second.index()) {
      text += parametersText(first, second);
    }
    text += projectionText(comparison.cameras[i], region);
  }
  if (!a.has_extrinsics || !b.has_extrinsics) {
    return text + "no extrinsics: T_cn_cnm1 is missing in one of the files\n";
  }
  return text + pairsText(comparison.pairs);
}

}  // namespace tartan_calib::apps
