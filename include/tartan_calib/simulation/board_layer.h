#pragma once

#include <opencv2/core.hpp>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/simulation/board_pattern.h"

namespace tartan_calib::simulation {

/// A board as a camera sees it at one moment, before blur: per pixel the fractions of its area that are covered.
struct BoardLayer {
  cv::Rect window;             ///< the part of the image that the board touches; empty where it is out of view
  cv::Mat1f sheet;             ///< of the window's size: covered by the sheet
  cv::Mat1f white;             ///< covered by white paper, at most `sheet`
  cv::Mat2f white_derivative;  ///< d(white) / d(shift of the board's image [px])
};

/// Draws the front of the board, or its white back where the camera is behind it. Pixel areas are exact: the cells' edges
/// are projected through the model and followed to kMaxChordError. Cells that the model cannot image are missing.
BoardLayer drawBoard(const BoardPattern& pattern, const camera::Camera& camera, const geometry::Rigid3& T_cam_target);

}  // namespace tartan_calib::simulation
