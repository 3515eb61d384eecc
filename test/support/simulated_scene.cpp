#include "support/simulated_scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tartan_calib::test_support {
namespace {

/// The angle from the axis at which pixels end, or max_polar_angle_rad where that comes first.
double halfFieldOfView(const camera::Camera& camera, double max_polar_angle_rad) {
  double largest_rad = 0.0;
  constexpr int kSteps = 20;
  for (int i = 0; i <= kSteps; ++i) {
    for (const Eigen::Vector2d& px : {Eigen::Vector2d(i * (camera.width - 1.0) / kSteps, 0.0),
                                      Eigen::Vector2d(0.0, i * (camera.height - 1.0) / kSteps)}) {
      if (const auto ray = camera::unproject(camera.model, px)) {
        largest_rad = std::max(largest_rad, std::acos(std::clamp(ray->z(), -1.0, 1.0)));
      } else {
        return max_polar_angle_rad;
      }
    }
  }
  return std::min(largest_rad, max_polar_angle_rad);
}

/// A board held somewhere in the camera's field of view. May be seen in part only.
geometry::Rigid3 randomBoardPose(const camera::Camera& camera, const std::vector<Eigen::Vector3d>& target_points,
                                 const SceneOptions& options, Random& random) {
  const double half_fov_rad = halfFieldOfView(camera, options.max_polar_angle_rad);
  const Eigen::Vector3d centre = 0.5 * (target_points.front() + target_points.back());
  const double radius_m = (target_points.back() - centre).norm();
  while (true) {
    const Eigen::Vector2d px(uniform(random, 0.0, camera.width - 1.0), uniform(random, 0.0, camera.height - 1.0));
    const auto ray = camera::unproject(camera.model, px);
    if (!ray || std::acos(ray->z()) > half_fov_rad) {
      continue;
    }
    constexpr double kLargestBoard_rad = 1.1;
    const double size_rad = std::min(uniform(random, options.min_size_ratio, options.max_size_ratio) * half_fov_rad,
                                     uniform(random, 0.5, 1.0) * kLargestBoard_rad);
    const Eigen::Vector3d towards_board = options.facing == Facing::kCamera ? *ray : Eigen::Vector3d::UnitZ();
    const double azimuth_rad = uniform(random, -M_PI, M_PI);
    const Eigen::Vector3d tilt_axis(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
    // The board's z axis points to the viewer.
    const Eigen::Quaterniond facing =
        geometry::rotationBetween(Eigen::Vector3d::UnitZ(), towards_board) *
        Eigen::AngleAxisd(uniform(random, options.min_tilt_rad, options.max_tilt_rad), tilt_axis) *
        Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()) *
        Eigen::AngleAxisd(uniform(random, -M_PI, M_PI), Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d board_centre = radius_m / std::tan(size_rad) * *ray;
    return geometry::Rigid3(facing, board_centre - facing * centre);
  }
}

/// Drops corners at random until `max_corners` are left.
void thinOut(std::vector<observation::Corner>& corners, int max_corners, Random& random) {
  while (static_cast<int>(corners.size()) > max_corners) {
    const auto index = static_cast<std::ptrdiff_t>(uniform(random, 0.0, static_cast<double>(corners.size())));
    corners.erase(corners.begin() + std::min(index, static_cast<std::ptrdiff_t>(corners.size()) - 1));
  }
}

/// Parameters of the model's shape with focal lengths 1 and principal point 0, drawn from what real lenses have.
Eigen::VectorXd randomShape(const std::string& model_name, Random& random) {
  const auto draw = [&random](double from, double to) { return uniform(random, from, to); };
  Eigen::VectorXd p = camera::parameters(camera::startModel(camera::modelByName(model_name), 1.0, {0.0, 0.0}));
  if (model_name == "pinhole-radtan") {
    p.tail<4>() << draw(-0.3, 0.02), draw(0.05, 0.09), draw(-5e-4, 5e-4), draw(-5e-4, 5e-4);
  } else if (model_name == "pinhole-equi") {
    p.tail<4>() << draw(-0.04, 0.04), draw(-0.008, 0.004), draw(-5e-4, 1e-3), draw(-1e-4, 5e-5);
  } else if (model_name == "pinhole-fov") {
    p(4) = draw(0.8, 1.1);
  } else if (model_name == "omni-none" || model_name == "omni-radtan") {
    p(0) = draw(0.6, 1.6);
    if (model_name == "omni-radtan") {
      p.tail<4>() << draw(-0.05, 0.02), draw(0.0, 0.01), draw(-5e-4, 5e-4), draw(-5e-4, 5e-4);
    }
  } else if (model_name == "eucm-none") {
    p.head<2>() << draw(0.5, 0.7), draw(0.8, 1.3);
  } else if (model_name == "ds-none") {
    p.head<2>() << draw(-0.3, 0.1), draw(0.5, 0.65);
  }
  p.segment<4>(camera::focalIndex(camera::modelByName(model_name))) << 1.0, 1.0, 0.0, 0.0;
  return p;
}

}  // namespace

observation::CameraView visibleCorners(const camera::Camera& camera, const std::vector<Eigen::Vector3d>& target_points,
                                       const geometry::Rigid3& T_cam_target, double max_polar_angle_rad) {
  observation::CameraView view;
  const Eigen::Vector3d viewer = T_cam_target.inverse().translation;
  if (viewer.z() <= 0.0) {
    return view;
  }
  for (std::size_t id = 0; id < target_points.size(); ++id) {
    const Eigen::Vector3d p_cam = T_cam_target * target_points[id];
    const auto px = camera::project(camera, p_cam);
    const double polar_angle_rad = std::atan2(p_cam.head<2>().norm(), p_cam.z());
    if (px && camera::isInside(camera, *px) && polar_angle_rad <= max_polar_angle_rad) {
      view.corners.push_back({static_cast<int>(id), *px});
    }
  }
  return view;
}

Scene simulateScene(const calibration::Rig& rig, const SceneOptions& options) {
  constexpr std::int64_t kPeriod_ns = 50'000'000;
  constexpr int kMaxTries = 100'000;
  Random random(options.seed);
  Scene scene;
  scene.target_points = target::cornerPoints(options.board);
  scene.rig = rig;
  for (int tries = 0; static_cast<int>(scene.views.size()) < options.num_views; ++tries) {
    if (tries == kMaxTries) {
      throw std::runtime_error("no board pose shows enough corners");
    }
    const std::size_t aimed = scene.views.size() % rig.cameras.size();
    const geometry::Rigid3 T_cam_target = randomBoardPose(rig.cameras[aimed].camera, scene.target_points, options, random);
    const geometry::Rigid3 T_rig_target = rig.cameras[aimed].T_cam_rig.inverse() * T_cam_target;
    observation::View view;
    view.stamp_ns = static_cast<std::int64_t>(scene.views.size() + 1) * kPeriod_ns;
    bool is_enough = false;
    for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
      observation::CameraView seen = visibleCorners(rig.cameras[i].camera, scene.target_points,
                                                    rig.cameras[i].T_cam_rig * T_rig_target, options.max_polar_angle_rad);
      is_enough = is_enough || (i == aimed && static_cast<int>(seen.corners.size()) >= options.min_corners);
      thinOut(seen.corners, options.max_corners, random);
      seen.camera_index = static_cast<int>(i);
      seen.stamp_ns = view.stamp_ns;
      if (!seen.corners.empty()) {
        view.cameras.push_back(seen);
      }
    }
    if (is_enough) {
      scene.views.push_back(view);
      scene.T_rig_target.push_back(T_rig_target);
    }
  }
  return scene;
}

Scene simulateScene(const camera::Camera& camera, const SceneOptions& options) {
  return simulateScene(calibration::Rig{{{camera, geometry::Rigid3()}}}, options);
}

std::vector<observation::CameraView> viewsOf(const std::vector<observation::View>& views, int camera_index) {
  std::vector<observation::CameraView> result;
  for (const observation::View& view : views) {
    for (const observation::CameraView& seen : view.cameras) {
      if (seen.camera_index == camera_index) {
        result.push_back(seen);
      }
    }
  }
  return result;
}

void addNoise(std::vector<observation::View>& views, double sigma_px, unsigned seed) {
  Random random(seed);
  forEachCorner(views, [&](observation::Corner& corner) {
    corner.px.x() += normal(random, sigma_px);
    corner.px.y() += normal(random, sigma_px);
  });
}

int addWrongCorners(std::vector<observation::View>& views, double ratio, double sigma_px, unsigned seed) {
  Random random(seed);
  int num_wrong = 0;
  forEachCorner(views, [&](observation::Corner& corner) {
    if (uniform(random, 0.0, 1.0) < ratio) {
      corner.px.x() += normal(random, sigma_px);
      corner.px.y() += normal(random, sigma_px);
      ++num_wrong;
    }
  });
  return num_wrong;
}

camera::Camera randomCamera(const std::string& model_name, double fov_rad, int width, int height, Random& random) {
  constexpr int kMaxTries = 1000;
  constexpr double kMargin_rad = 0.02;  // that the model goes on beyond the last ray seen
  const camera::CameraModel kind = camera::modelByName(model_name);
  const double edge_rad = 0.5 * fov_rad;
  const auto ray = [](double angle_rad) { return Eigen::Vector3d(std::sin(angle_rad), 0.0, std::cos(angle_rad)); };
  for (int tries = 0; tries < kMaxTries; ++tries) {
    Eigen::VectorXd p = randomShape(model_name, random);
    const camera::CameraModel unit = camera::withParameters(kind, p);
    const auto edge = camera::project(unit, ray(edge_rad));
    if (!edge || !camera::project(unit, ray(edge_rad + kMargin_rad))) {
      continue;
    }
    const double focal_px = 0.5 * width / edge->x();
    p.segment<4>(camera::focalIndex(kind)) << focal_px, focal_px, 0.5 * (width - 1), 0.5 * (height - 1);
    return {camera::withParameters(kind, p), width, height};
  }
  throw std::runtime_error(model_name + " has no lens of " + std::to_string(fov_rad) + " rad");
}

}  // namespace tartan_calib::test_support
