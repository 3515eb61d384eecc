#pragma once

#include "bent_board.h"
#include "board_poses.h"
#include "search_history.h"
#include "tartan_calib/detection/corner_recovery.h"
#include "tartan_calib/pipeline/calibrate.h"
#include "view_detection.h"

namespace tartan_calib::pipeline {

/// What a round knows when it goes through the images again.
struct RoundStart {
  const calibration::Solution& solution;
  const BoardPoses& poses;
  const std::vector<Eigen::Vector3d>& target_points;  ///< with the board's curvature
  const BoardShape& shape;
};

/// Where a round looks for corners in the images of one camera.
struct RoundSearch {
  const detection::CornerRecovery* recovery;  ///< at the predictions; null: not there
  const ViewDetection& views;
  double half_window_m;    ///< on the board, for refining what the views show
  SearchHistory& history;  ///< images whose predictions have not moved since are left alone; extended
};

/// The corners of all images of one camera, looked for where the solution says that they are. `previous`: what the camera
/// saw so far; its corners that are not found again are kept where they are close to the solution's predictions.
CameraCorners recoverCorners(const CameraStream& stream, int camera_index, const RoundSearch& search,
                             const RoundStart& start, const CameraCorners& previous, const CalibrateOptions& options,
                             const Listener& listener);

}  // namespace tartan_calib::pipeline
