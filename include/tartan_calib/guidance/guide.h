#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/guidance/advice.h"
#include "tartan_calib/guidance/kept_views.h"
#include "tartan_calib/pipeline/calibrate.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::guidance {

struct GuideOptions {
  pipeline::CalibrateOptions calibrate;  ///< models, smallest number of tags, synchronisation, ...
  std::size_t max_views = 100;           ///< that are kept
  std::size_t max_bytes = 512u << 20;    ///< of their images
  double max_blur_px = 2.0;              ///< edgeBlur of an image that is kept
  double min_change_ratio = 0.04;        ///< viewChange from every kept view, before there is a calibration and after
  double min_gain_bits = 0.1;            ///< that a view has to add to what is known, once there is a calibration
  std::size_t first_solve_views = 8;     ///< kept, for the first calibration
};

/// An image and what was seen in it.
struct SeenImage {
  int camera_index = 0;
  std::int64_t stamp_ns = 0;
  cv::Mat gray;  ///< CV_8UC1
  std::vector<observation::Corner> corners;
  std::optional<double> blur_px;  ///< edgeBlur
};

enum class Decision {
  kKept,
  kKeptInstead,  ///< of one that says less, or of the same one less sharp
  kNoBoard,      ///< or too little of it
  kBlurred,
  kOtherSize,  ///< than the images before
  kKnown,      ///< says too little beyond what is kept
};

/// `kept`, `blurred`, ...
std::string decisionText(Decision decision);

struct Advice {
  std::string text;
  std::optional<BoardCandidate> candidate;  ///< where to hold the board, once there is a calibration
  double gain_bits = 0.0;                   ///< that a view there would add
};

/// Collects the views of a rig that are worth calibrating with, and says where to hold the board next: as long as no
/// calibration exists, where the images lack something; then, where a view would say most. Bounded in memory. Deterministic,
/// except that solves run wherever their owner runs them. Not thread-safe.
class Guide {
 public:
  Guide(const target::Target& target, std::size_t num_cameras, const GuideOptions& options);

  /// Images of one time, at most one per camera. Keeps those that are of use, and says what became of each.
  std::vector<Decision> offer(const std::vector<SeenImage>& images);

  /// What to do next, for a board that is seen in these images.
  Advice advise(const std::vector<SeenImage>& images) const;

  /// A calibration from the kept corners, to be run on any thread; empty where none is due. It returns nothing where they
  /// do not determine one.
  using Solve = std::function<std::optional<calibration::Rig>()>;
  std::optional<Solve> nextSolve(const std::function<bool()>& is_cancelled);
  void adopt(const calibration::Rig& rig);

  const std::vector<KeptView>& kept() const { return kept_; }
  std::size_t numKept(int camera_index) const;
  const std::optional<calibration::Rig>& rig() const { return rig_; }
  const std::vector<Eigen::Vector3d>& targetPoints() const { return target_points_; }

  /// Empty until the camera's first image.
  const CoverageMap* coverage(int camera_index) const;

 private:
  struct Weakest {
    std::size_t index = 0;
    double loss_bits = 0.0;
  };

  std::optional<Decision> reasonAgainst(const SeenImage& image) const;
  Decision consider(KeptView view, const std::vector<SeenImage>& images);
  Decision keep(KeptView view, const std::vector<SeenImage>& images, std::optional<std::size_t> instead_of);
  void inform(KeptView& view) const;
  Weakest weakest() const;
  bool isFull() const;
  void refresh();
  void chooseCandidate();
  Advice informedAdvice(const std::vector<SeenImage>& images) const;
  std::vector<pipeline::CameraCorners> keptCorners() const;

  target::Target target_;
  std::vector<Eigen::Vector3d> target_points_;
  GuideOptions options_;
  std::vector<std::optional<CoverageMap>> coverage_;
  std::vector<double> diagonals_px_;
  std::vector<KeptView> kept_;
  std::size_t num_changes_ = 0;  ///< of kept_, since the last solve began
  bool solve_failed_ = false;    ///< the last one

  std::optional<calibration::Rig> rig_;
  Eigen::MatrixXd known_;  ///< information of the kept views, and the prior
  std::vector<BoardCandidate> candidates_;
  std::optional<std::size_t> best_candidate_;
  double best_gain_bits_ = 0.0;
};

}  // namespace tartan_calib::guidance
