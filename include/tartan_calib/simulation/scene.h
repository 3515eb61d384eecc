#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/simulation/sensor.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::simulation {

/// A lens on its place in the rig. The rig frame is that of camera 0: x right, y down, z forward, y along gravity.
struct SceneCamera {
  camera::Camera camera;
  geometry::Rigid3 T_cam_rig;
  double image_circle_px = std::numeric_limits<double>::infinity();  ///< radius around the principal point; black outside
  double vignetting = 0.4;  ///< part of the light that is lost at the image circle or in the corners
  double delay_s = 0.0;     ///< how much later than the frame's stamp it exposes: 0 where the cameras are in sync
};

/// A forearm with a spread hand that lies on the board, in the target frame.
struct Hand {
  Eigen::Vector2d palm_m = Eigen::Vector2d::Zero();  ///< centre of the palm
  double direction_rad = 0.0;                        ///< from the palm to the middle finger, from +x to +y
  double scale = 1.0;                                ///< 1 is an adult's hand
};

/// One exposure of all cameras.
struct SceneFrame {
  std::int64_t stamp_ns = 0;
  geometry::Rigid3 T_rig_target;  ///< in the middle of the exposure; the truth
  /// Motion of the board during the exposure: T_rig_target * exp(s * motion) for s from -1/2 to 1/2.
  geometry::Vector6d motion = geometry::Vector6d::Zero();
  /// Motion of the board per second, which cameras with a delay see: T_rig_target * exp(delay_s * velocity).
  geometry::Vector6d velocity = geometry::Vector6d::Zero();
  std::optional<Hand> hand;
  double exposure_ratio = 1.0;  ///< of the exposure for which Lighting tells the grey levels
  double heading_rad = 0.0;     ///< of the rig in the room, about the vertical
};

/// T_cam_target in the middle of the camera's exposure.
inline geometry::Rigid3 boardPose(const SceneCamera& camera, const SceneFrame& frame) {
  return camera.T_cam_rig * frame.T_rig_target * geometry::expRigid(camera.delay_s * frame.velocity);
}

/// Lamp and paper. Grey levels at the lens' axis, under full light.
struct Lighting {
  double white_grey = 205.0;
  double black_grey = 22.0;
  Eigen::Vector3d lamp_rig = Eigen::Vector3d(0.35, -0.8, -0.5);  ///< direction towards the lamp
  double ambient_ratio = 0.6;                                    ///< light that comes from everywhere
  double sheen_ratio = 0.25;                                     ///< of the paper, towards the lamp's mirror image
  double sheen_width_rad = 0.6;
};

/// Everything that a recording shows. Frames are rendered alone and in any order.
struct Scene {
  target::Target target;
  double board_margin_m = 0.04;  ///< white paper around the pattern
  std::vector<SceneCamera> cameras;
  std::vector<SceneFrame> frames;
  Lighting lighting;
  SensorOptions sensor;
  std::uint64_t seed = 1;  ///< of the room and of the noise
};

}  // namespace tartan_calib::simulation
