#include "bent_board.h"

namespace tartan_calib::pipeline {

detection::BoardMap boardMap(const camera::Camera& camera, const geometry::Rigid3& T_cam_target, const BoardShape& shape) {
  return std::visit(
      [&](const auto& model) -> detection::BoardMap {
        const Eigen::Matrix3d R = T_cam_target.rotation.toRotationMatrix();
        return [model, pupil = camera.pupil, R, t = T_cam_target.translation,
                shape](const Eigen::Vector2d& p_m) -> std::optional<Eigen::Vector2d> {
          const Eigen::Vector3d p_target(p_m.x(), p_m.y(), shape.bend.at(p_m).dot(shape.warp_m));
          const camera::ShiftedModel<std::decay_t<decltype(model)>> shifted{model, pupil};
          Eigen::Vector2d px;
          if (!shifted.project(R * p_target + t, px)) {
            return std::nullopt;
          }
          return px;
        };
      },
      camera.model);
}

}  // namespace tartan_calib::pipeline
