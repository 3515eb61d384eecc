#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "lens_shading.h"
#include "room.h"
#include "tartan_calib/simulation/board_pattern.h"
#include "tartan_calib/simulation/scene.h"

namespace tartan_calib::simulation {

/// What a camera's sensor collects in one exposure, before noise.
struct Exposure {
  cv::Mat1f light;             ///< grey levels
  cv::Rect board_window;       ///< the part of the image that the board touches; empty where it is out of view
  cv::Mat2f light_derivative;  ///< of the window's size: d(light) / d(shift of the board's image [px])
  cv::Mat1b occluded;          ///< 255 where a hand covers a part of the pixel at any time; empty without a hand
  cv::Mat1f cover;             ///< part of each pixel that the hand covers in the middle; empty as `occluded`
};

/// One camera of a scene with everything that is the same in all of its pictures.
class ExposureMaker {
 public:
  ExposureMaker(const Scene& scene, const SceneCamera& camera);

  Exposure expose(const Scene& scene, const BoardPattern& pattern, const Room& room, const SceneFrame& frame) const;

 private:
  /// Poses of the board at the middles of equal parts of the exposure, so many that it moves by half a pixel between them.
  std::vector<geometry::Rigid3> boardPoses(const Scene& scene, const SceneFrame& frame) const;

  SceneCamera camera_;
  cv::Mat2f room_directions_;
  cv::Mat1f shading_;
  BoardLight board_light_;
};

}  // namespace tartan_calib::simulation
