#include "bent_board.h"

namespace tartan_calib::pipeline {

detection::BoardMap boardMap(const camera::Camera& camera, const geometry::Rigid3& T_cam_target, const BoardShape& shape) {
  const Eigen::Matrix3d R = T_cam_target.rotation.toRotationMatrix();
  return [camera, R, t = T_cam_target.translation, shape](const Eigen::Vector2d& p_m) {
    const Eigen::Vector3d p_target(p_m.x(), p_m.y(), shape.bend.at(p_m).dot(shape.warp_m));
    return project(camera, R * p_target + t);
  };
}

}  // namespace tartan_calib::pipeline
