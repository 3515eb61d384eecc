#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "tartan_calib/detection/board_map.h"
#include "tartan_calib/detection/refine.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::detection {

/// Where to stop and what to accept; as kalibr_calibrate_cameras, if not said otherwise.
struct WindowRefineOptions {
  int half_window_px = 2;
  int max_iterations = 30;
  double min_step_px = 0.1;
  double max_shift_px = 1.2247448713915890;  ///< from the start; sqrt(1.5)
};

/// cv::cornerSubPix: the point p that minimises the sum over a square window of (g(q) . (q - p))^2, g the gradient at q.
/// Near the border of the image the window is smaller. The covariance is that of the noise of the pixels, carried through
/// the sum, and of what is left to go where the iteration ends.
std::optional<RefinedCorner> refineInWindow(const cv::Mat& gray, const Eigen::Vector2d& start_px,
                                            const WindowRefineOptions& options);

/// The window of TartanCalib, eq. 6: so much of the distance to the nearest corner of the board, as predicted.
struct AdaptiveWindowOptions {
  double scale = 0.4;
  int min_half_window_px = 2;
  int max_half_window_px = 8;
};

/// Neighbours of every corner of a board. Those at its rim have some that are not printed, as far away as in its middle.
class CornerNeighbours {
 public:
  explicit CornerNeighbours(const target::Target& target);

  /// Distance [px] to the nearest neighbour that the map shows; infinite where it shows none.
  double nearest_px(const BoardMap& map, int corner_id) const;

 private:
  target::Lattice lattice_;
  std::vector<double> col_m_;  ///< places of the lattice's columns, one more at each end
  std::vector<double> row_m_;  ///< of its rows
  bool x_along_rows_ = false;  ///< a checkerboard's x counts rows
};

/// Half of the adaptive window [px], a whole number.
int adaptiveHalfWindow(double nearest_px, const AdaptiveWindowOptions& options);

}  // namespace tartan_calib::detection
