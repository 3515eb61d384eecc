#pragma once

#include <Eigen/Core>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tartan_calib/calibration/rig.h"
#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/observation/observation.h"
#include "tartan_calib/target/target.h"

/// Corners of a board in front of a rig, without images. The scene is exact; noise and wrong corners are added apart, so
/// that a test can always compare with the truth.
namespace tartan_calib::test_support {

using Random = std::mt19937;

inline double uniform(Random& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

inline double normal(Random& random, double sigma) { return std::normal_distribution<double>(0.0, sigma)(random); }

struct Scene {
  std::vector<Eigen::Vector3d> target_points;  ///< [m], by corner id
  calibration::Rig rig;
  std::vector<geometry::Rigid3> T_rig_target;  ///< one per view
  std::vector<observation::View> views;        ///< exact corners, 50 ms apart
};

/// What the boards in front of the camera face.
enum class Facing {
  kCamera,      ///< along the line of sight to the board
  kImagePlane,  ///< along the optical axis: fronto-parallel
};

struct SceneOptions {
  int num_views = 40;
  double max_polar_angle_rad = M_PI;  ///< corners further from the axis are not seen
  double min_tilt_rad = 0.0;          ///< of the board against where it faces
  double max_tilt_rad = 0.8;
  Facing facing = Facing::kCamera;
  /// The board's half diagonal, seen from the camera, as a share of half the field of view.
  double min_size_ratio = 0.3;
  double max_size_ratio = 0.9;
  int min_corners = 16;       ///< that the camera sees at which the board is held
  int max_corners = 1 << 20;  ///< more are thinned out at random
  unsigned seed = 1;
  target::AprilGrid board;
};

/// A camera of that model with random lens shape, square pixels, principal point in the centre: the ray `fov_rad` / 2 from
/// the axis falls on the image's left and right edge.
camera::Camera randomCamera(const std::string& model_name, double fov_rad, int width, int height, Random& random);

/// Corners in the image and in front of the board, by increasing id.
observation::CameraView visibleCorners(const camera::Camera& camera, const std::vector<Eigen::Vector3d>& target_points,
                                       const geometry::Rigid3& T_cam_target, double max_polar_angle_rad);

/// What all cameras of the rig see while the board is held in front of each camera in turn.
Scene simulateScene(const calibration::Rig& rig, const SceneOptions& options);

Scene simulateScene(const camera::Camera& camera, const SceneOptions& options);

/// The views of one camera, in order.
std::vector<observation::CameraView> viewsOf(const std::vector<observation::View>& views, int camera_index);

/// Calls `change` for every corner.
template <typename Change>
void forEachCorner(std::vector<observation::View>& views, const Change& change) {
  for (observation::View& view : views) {
    for (observation::CameraView& seen : view.cameras) {
      for (observation::Corner& corner : seen.corners) {
        change(corner);
      }
    }
  }
}

/// Gaussian noise on every coordinate.
void addNoise(std::vector<observation::View>& views, double sigma_px, unsigned seed);

/// Moves a share of all corners by Gaussian gross errors. Returns how many.
int addWrongCorners(std::vector<observation::View>& views, double ratio, double sigma_px, unsigned seed);

camera::Camera randomCamera(const std::string& model_name, double fov_rad, int width, int height, Random& random);

}  // namespace tartan_calib::test_support
