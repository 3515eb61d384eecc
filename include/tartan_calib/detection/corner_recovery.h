#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "tartan_calib/detection/board_map.h"
#include "tartan_calib/detection/window_refine.h"
#include "tartan_calib/observation/observation.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::detection {

struct CornerCandidate;
struct CornerSearch;
class TagPayload;

/// What says that a predicted corner is in the image.
enum class CornerFilter {
  kImage,  ///< the image at the prediction: X-corner, payload, neighbours
  kQuads,  ///< a quadrilateral whose four corners are close to those of one predicted tag; AprilGrids only
};

/// How corners are moved to sub-pixel accuracy.
enum class Refinement {
  kSymmetry,  ///< refineBySymmetry, through the map
  kAdaptive,  ///< refineInWindow with TartanCalib's window
  kFixed,     ///< refineInWindow with Kalibr's
};

struct RecoveryOptions {
  CornerFilter filter = CornerFilter::kImage;
  double search_radius_px = 4.0;  ///< how far a corner may be from its prediction
  double min_border_px = 2.0;     ///< corners closer to the image border are not looked for
  double min_neighbour_px = 4.0;  ///< nor those whose nearest corner on the board is closer
  Refinement refinement = Refinement::kSymmetry;
  /// Half-width of Refinement::kSymmetry's window, in those of the square around a corner in which the board is symmetric.
  /// A window of more than 1 stays as large everywhere, whatever is in it.
  double symmetry_window = 0.9;
  AdaptiveWindowOptions adaptive_window;  ///< of Refinement::kAdaptive
  double min_correlation = 0.8;           ///< of the grey values around a corner with the pattern expected there
  double min_contrast = 8.0;              ///< light minus dark around a corner [grey levels]
  double max_field_deviation_px = 1.0;    ///< of a corner's shift from its prediction against its neighbours' shifts
  double max_quad_distance_px = 1.41;     ///< kQuads: from a quadrilateral's corner to the tag's; TartanCalib's default
};

/// Where the refinement of a corner begins.
struct CornerSeed {
  int corner_id = -1;
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
};

/// Finds the corners of a board whose place in the image is roughly known. No straight edges and no decoded tag are needed:
/// around each predicted corner the image must show an X-corner of the predicted orientation and polarity; shifts from the
/// predictions must agree between neighbours; and the payload of the tag, sampled through the map, must agree with its id,
/// or, where it does not show another tag, neighbours on tags that agree must vouch for the corner. A covered corner is not
/// reported. That is CornerFilter::kImage; kQuads is the filter of Duisterhof et al. 2022, for comparison.
class CornerRecovery {
 public:
  explicit CornerRecovery(const target::Target& target, const RecoveryOptions& options = {});

  /// Corners by increasing id, refined by symmetry through the map, with covariances. `gray`: CV_8UC1.
  std::vector<observation::Corner> recover(const cv::Mat& gray, const BoardMap& map) const;

  /// Moves one corner to sub-pixel accuracy by the chosen Refinement, as `recover` does with what it has found. Nothing
  /// where that does not end near.
  std::optional<RefinedCorner> refine(const cv::Mat& gray, const BoardMap& map, const CornerSeed& seed) const;

 private:
  std::vector<CornerCandidate> recoverCandidates(const cv::Mat& gray, const BoardMap& map, int dark_diagonal) const;
  std::vector<CornerCandidate> recoverOnQuads(const cv::Mat& gray, const BoardMap& map) const;
  std::vector<CornerCandidate> predict(const cv::Mat& gray, const BoardMap& map, int dark_diagonal) const;
  void find(const cv::Mat& gray, const BoardMap& map, const Eigen::Vector2d& expected_shift_px, double radius_px,
            CornerCandidate& candidate) const;
  void findWithin(const cv::Mat& gray, const BoardMap& map, const CornerSearch& search, CornerCandidate& candidate) const;
  void findAgain(const cv::Mat& gray, const BoardMap& map, std::vector<CornerCandidate>& candidates) const;

  target::Target target_;
  RecoveryOptions options_;
  std::vector<Eigen::Vector3d> corner_points_;
  target::Lattice lattice_;
  std::shared_ptr<const TagPayload> payload_;  ///< null unless the target is an AprilGrid
  CornerNeighbours neighbours_;
  double half_window_m_ = 0.0;  ///< of the templates
};

}  // namespace tartan_calib::detection
