#include <algorithm>
#include <iostream>
#include <limits>
#include <map>
#include <opencv2/core.hpp>

#include "board_poses.h"
#include "common/program.h"
#include "tartan_calib/detection/refine.h"
#include "tartan_calib/io/camchain.h"
#include "tartan_calib/io/corners_csv.h"
#include "tartan_calib/io/image_folder.h"
#include "tartan_calib/io/target_yaml.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace {

using namespace tartan_calib;

constexpr const char* kHelp =
    R"(Refines another detector's corners as a round does: by symmetry, sampled through a calibrated lens.

  refine_corners folder corners.csv target.yaml camchain.yaml refined.csv

For boards that this tool cannot identify. One camera, images in kalibr_bagcreater's layout. The lens stays as it is; board poses
are solved from the corners. Corners around which nothing is symmetric are left out.
)";

struct Inputs {
  target::Target target;
  pipeline::CameraCorners corners;
  calibration::Rig rig;
  pipeline::CameraStream images;
};

Inputs open(char** files) {
  Inputs inputs;
  inputs.corners = io::loadCorners(files[1]).front();
  inputs.target = io::loadTarget(files[2]).target;
  inputs.rig = io::loadCamchain(files[3]).rig;
  inputs.images = io::openImageFolder(files[0], {inputs.corners.topic}, {}).front();
  return inputs;
}

/// The corners of one image that lie where `camera` and the board's pose say that the board is symmetric.
std::vector<observation::Corner> refine(const cv::Mat& gray, const target::Target& target, const camera::Camera& camera,
                                        const geometry::Rigid3& T_cam_target,
                                        const std::vector<observation::Corner>& corners) {
  detection::RefineOptions options;
  options.half_window = detection::RecoveryOptions().symmetry_window * target::symmetricHalfWidth(target);
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(target);
  std::vector<observation::Corner> refined;
  for (const observation::Corner& corner : corners) {
    const Eigen::Vector3d& point = points[static_cast<std::size_t>(corner.corner_id)];
    const auto project = [&](const Eigen::Vector2d& offset_m) -> Eigen::Vector2d {
      const auto px =
          camera::project(camera.model, T_cam_target * (point + Eigen::Vector3d(offset_m.x(), offset_m.y(), 0.0)));
      return px ? *px : Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    };
    const Eigen::Vector2d origin_px = project(Eigen::Vector2d::Zero());
    const auto offset_map = [&](const Eigen::Vector2d& offset_m) -> Eigen::Vector2d {
      return project(offset_m) - origin_px;
    };
    if (const auto found = detection::refineBySymmetry(gray, corner.px, offset_map, options)) {
      refined.push_back({corner.corner_id, found->px, found->cov_px2});
    }
  }
  return refined;
}

int run(int argc, char** argv) {
  constexpr int kNumFiles = 5;
  if (argc != 1 + kNumFiles) {
    std::cout << kHelp;
    return apps::kWrongUsage;
  }
  Inputs inputs = open(argv + 1);
  const std::map<std::int64_t, geometry::Rigid3> poses = boardPoses(inputs.corners, inputs.target, inputs.rig);
  std::map<std::int64_t, cv::Mat> images;
  const pipeline::ImageSource source = inputs.images.open();
  while (const std::optional<pipeline::StampedImage> image = source()) {
    images[image->stamp_ns] = image->load();
  }
  for (observation::CameraView& view : inputs.corners.images) {
    const auto pose = poses.find(view.stamp_ns);
    const auto image = images.find(view.stamp_ns);
    const bool is_known = pose != poses.end() && image != images.end();
    view.corners = is_known
                       ? refine(image->second, inputs.target, inputs.rig.cameras.front().camera, pose->second, view.corners)
                       : std::vector<observation::Corner>();
  }
  io::saveCorners(argv[kNumFiles], {inputs.corners});
  return apps::kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  return apps::runProgram([&] { return run(argc, argv); });
}
