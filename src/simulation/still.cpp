#include "tartan_calib/simulation/still.h"

#include "tartan_calib/simulation/board_layer.h"
#include "tartan_calib/simulation/board_pattern.h"
#include "tartan_calib/simulation/sensor.h"

namespace tartan_calib::simulation {

Still renderStill(const target::Target& target, const camera::Camera& camera, const geometry::Rigid3& T_cam_target,
                  const StillOptions& options) {
  cv::Mat1f grey(camera.height, camera.width, static_cast<float>(options.background_grey));
  const BoardLayer board = drawBoard(boardPattern(target, options.margin_m), camera, T_cam_target);
  if (!board.window.empty()) {
    cv::Mat behind = grey(board.window);
    const cv::Mat seen = behind + board.sheet * (options.black_grey - options.background_grey) +
                         board.white * (options.white_grey - options.black_grey);
    seen.copyTo(behind);
  }
  applyPsf(grey, options.psf_sigma_px);
  const SensorOptions sensor{options.psf_sigma_px, options.noise_sigma, 0.0};
  return {expose(grey, sensor, options.seed), projectCorners(target, camera, T_cam_target)};
}

}  // namespace tartan_calib::simulation
