#include "tartan_calib/guidance/guide.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tartan_calib/calibration/information.h"
#include "tartan_calib/calibration/pose.h"
#include "tartan_calib/guidance/information.h"
#include "tartan_calib/text.h"

namespace tartan_calib::guidance {
namespace {

using geometry::Rigid3;
using observation::CameraView;
using observation::View;

/// A view almost like a kept one takes its place if it is that much sharper.
constexpr double kSharper_ratio = 0.7;

/// A view takes the place of the kept one that says least only for a clear gain: else equals would swap for ever.
constexpr double kExchange_ratio = 1.2;

/// A place is proposed only that far from where the board was kept before, in smallest changes: a hand is not more precise.
constexpr double kElsewhere_ratio = 2.0;

/// Kept views that must have changed before the next solve, at least, and as a share of all.
constexpr std::size_t kMinChanges = 3;
constexpr std::size_t kChangesPerView = 5;

std::size_t minTagsOf(const target::Target& target, const pipeline::CalibrateOptions& options) {
  const auto* grid = std::get_if<target::AprilGrid>(&target);
  return grid == nullptr ? 0 : static_cast<std::size_t>(options.min_tags.value_or(pipeline::minTags(*grid)));
}

/// Pose of the board from the camera that sees most of it.
std::optional<Rigid3> boardPose(const calibration::Rig& rig, const std::vector<Eigen::Vector3d>& target_points,
                                const View& view) {
  const auto most = std::max_element(view.cameras.begin(), view.cameras.end(),
                                     [](const auto& a, const auto& b) { return a.corners.size() < b.corners.size(); });
  if (most == view.cameras.end()) {
    return std::nullopt;
  }
  const calibration::RigCamera& camera = rig.cameras[static_cast<std::size_t>(most->camera_index)];
  const auto T_cam_target = calibration::estimatePose(camera.camera, target_points, most->corners);
  return T_cam_target ? std::make_optional(camera.T_cam_rig.inverse() * *T_cam_target) : std::nullopt;
}

CameraView cameraView(const SeenImage& image) {
  CameraView view{image.camera_index, image.stamp_ns, image.corners};
  for (observation::Corner& corner : view.corners) {
    corner.cov_px2.setIdentity();  // of all alike, as of corners that are only planned
  }
  return view;
}

}  // namespace

std::string decisionText(Decision decision) {
  switch (decision) {
    case Decision::kKept:
      return "kept";
    case Decision::kKeptInstead:
      return "kept instead of another view";
    case Decision::kNoBoard:
      return "too little of the board";
    case Decision::kBlurred:
      return "blurred";
    case Decision::kOtherSize:
      return "other image size";
    case Decision::kKnown:
      return "nothing new";
  }
  return "";
}

Guide::Guide(const target::Target& target, std::size_t num_cameras, const GuideOptions& options)
    : target_(target),
      target_points_(target::cornerPoints(target)),
      options_(options),
      coverage_(num_cameras),
      diagonals_px_(num_cameras, 0.0) {}

const CoverageMap* Guide::coverage(int camera_index) const {
  const auto& map = coverage_[static_cast<std::size_t>(camera_index)];
  return map ? &*map : nullptr;
}

std::size_t Guide::numKept(int camera_index) const {
  return static_cast<std::size_t>(std::count_if(kept_.begin(), kept_.end(), [&](const KeptView& kept) {
    return std::any_of(kept.images.begin(), kept.images.end(),
                       [&](const EncodedImage& image) { return image.camera_index == camera_index; });
  }));
}

std::optional<Decision> Guide::reasonAgainst(const SeenImage& image) const {
  constexpr std::size_t kMinCorners = 6;
  const CoverageMap& coverage = *coverage_[static_cast<std::size_t>(image.camera_index)];
  if (image.gray.cols != coverage.width() || image.gray.rows != coverage.height()) {
    return Decision::kOtherSize;
  }
  const auto* grid = std::get_if<target::AprilGrid>(&target_);
  const auto num_tags = grid == nullptr ? 0 : static_cast<std::size_t>(pipeline::countTags(*grid, image.corners));
  if (image.corners.size() < kMinCorners || num_tags < minTagsOf(target_, options_.calibrate)) {
    return Decision::kNoBoard;
  }
  return image.blur_px && *image.blur_px > options_.max_blur_px ? std::make_optional(Decision::kBlurred) : std::nullopt;
}

std::vector<Decision> Guide::offer(const std::vector<SeenImage>& images) {
  KeptView candidate;
  std::vector<SeenImage> usable;
  std::vector<std::optional<Decision>> reasons;
  for (const SeenImage& image : images) {
    const auto at = static_cast<std::size_t>(image.camera_index);
    if (!coverage_[at]) {
      coverage_[at].emplace(image.gray.cols, image.gray.rows);
      diagonals_px_[at] = std::hypot(image.gray.cols, image.gray.rows);
    }
    reasons.push_back(reasonAgainst(image));
    if (reasons.back() != Decision::kOtherSize) {
      coverage_[at]->addImage(image.gray);
    }
    if (!reasons.back()) {
      usable.push_back(image);
      candidate.view.cameras.push_back(cameraView(image));
      candidate.blur_px = std::max(candidate.blur_px, image.blur_px.value_or(0.0));
    }
  }
  Decision of_view = Decision::kNoBoard;
  if (!usable.empty()) {
    candidate.view.stamp_ns = usable.front().stamp_ns;
    of_view = consider(std::move(candidate), usable);
  }
  std::vector<Decision> decisions;
  decisions.reserve(reasons.size());
  for (const std::optional<Decision>& reason : reasons) {
    decisions.push_back(reason.value_or(of_view));
  }
  return decisions;
}

Decision Guide::consider(KeptView candidate, const std::vector<SeenImage>& images) {
  std::optional<std::size_t> nearest;
  double smallest_change = options_.min_change_ratio;
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const double change = viewChange(candidate.view, kept_[i].view, diagonals_px_);
    if (change < smallest_change || kept_[i].view.stamp_ns == candidate.view.stamp_ns) {
      nearest = i;
      smallest_change = change;
    }
  }
  if (nearest) {
    const KeptView& same = kept_[*nearest];
    const bool is_better =
        candidate.blur_px < kSharper_ratio * same.blur_px && candidate.view.cameras.size() >= same.view.cameras.size();
    return is_better ? keep(std::move(candidate), images, nearest) : Decision::kKnown;
  }
  if (!rig_) {
    return isFull() ? Decision::kKnown : keep(std::move(candidate), images, std::nullopt);
  }
  inform(candidate);
  if (candidate.information.size() == 0) {
    return Decision::kKnown;  // no pose explains it
  }
  const double gain_bits = gainBits(known_, candidate.information);
  if (gain_bits < options_.min_gain_bits) {
    return Decision::kKnown;
  }
  if (!isFull()) {
    return keep(std::move(candidate), images, std::nullopt);
  }
  const Weakest least = weakest();
  return gain_bits > kExchange_ratio * least.loss_bits ? keep(std::move(candidate), images, least.index) : Decision::kKnown;
}

Decision Guide::keep(KeptView candidate, const std::vector<SeenImage>& images, std::optional<std::size_t> instead_of) {
  for (const SeenImage& image : images) {
    candidate.images.push_back(encodeImage(image.camera_index, image.stamp_ns, image.gray));
  }
  if (rig_ && candidate.information.size() == 0) {
    inform(candidate);
  }
  if (instead_of) {
    kept_[*instead_of] = std::move(candidate);
  } else {
    kept_.push_back(std::move(candidate));
  }
  ++num_changes_;
  refresh();
  return instead_of ? Decision::kKeptInstead : Decision::kKept;
}

bool Guide::isFull() const {
  std::size_t bytes = 0;
  for (const KeptView& kept : kept_) {
    bytes += encodedBytes(kept);
  }
  return kept_.size() >= options_.max_views || bytes >= options_.max_bytes;
}

void Guide::inform(KeptView& view) const {
  view.T_rig_target = boardPose(*rig_, target_points_, view.view);
  view.information = view.T_rig_target ? calibration::viewInformation(*rig_, target_points_, view.view, *view.T_rig_target)
                                       : Eigen::MatrixXd();
}

Guide::Weakest Guide::weakest() const {
  std::optional<Weakest> least;
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const Eigen::MatrixXd& information = kept_[i].information;
    const double loss_bits = information.size() == 0 ? 0.0 : gainBits(known_ - information, information);
    if (!least || loss_bits < least->loss_bits) {
      least = Weakest{i, loss_bits};
    }
  }
  return *least;
}

void Guide::refresh() {
  for (auto& coverage : coverage_) {
    if (coverage) {
      coverage->clearCorners();
    }
  }
  for (const KeptView& kept : kept_) {
    for (const CameraView& image : kept.view.cameras) {
      coverage_[static_cast<std::size_t>(image.camera_index)]->addCorners(image.corners);
    }
  }
  if (!rig_) {
    return;
  }
  known_ = priorInformation(*rig_);
  for (const KeptView& kept : kept_) {
    if (kept.information.size() > 0) {
      known_ += kept.information;
    }
  }
  chooseCandidate();
}

void Guide::chooseCandidate() {
  std::vector<double> gains_bits;
  for (const BoardCandidate& candidate : candidates_) {
    gains_bits.push_back(gainBits(known_, candidate.information));
  }
  const auto is_new = [&](const BoardCandidate& candidate) {
    return std::none_of(kept_.begin(), kept_.end(), [&](const KeptView& kept) {
      return viewChange(candidate.view, kept.view, diagonals_px_) < kElsewhere_ratio * options_.min_change_ratio;
    });
  };
  best_candidate_.reset();
  best_gain_bits_ = 0.0;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    if (gains_bits[i] > best_gain_bits_ && is_new(candidates_[i])) {
      best_candidate_ = i;
      best_gain_bits_ = gains_bits[i];
    }
  }
}

void Guide::adopt(const calibration::Rig& rig) {
  rig_ = rig;
  for (KeptView& kept : kept_) {
    inform(kept);
  }
  std::vector<CoverageMap> coverage;
  for (const auto& map : coverage_) {
    coverage.push_back(*map);
  }
  candidates_ = boardCandidates(*rig_, target_points_, coverage);
  refresh();
}

std::vector<pipeline::CameraCorners> Guide::keptCorners() const {
  std::vector<pipeline::CameraCorners> cameras(coverage_.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    cameras[i].topic = cameraName(i);
    cameras[i].width = coverage_[i]->width();
    cameras[i].height = coverage_[i]->height();
  }
  for (const KeptView& kept : kept_) {
    for (const CameraView& image : kept.view.cameras) {
      pipeline::CameraCorners& camera = cameras[static_cast<std::size_t>(image.camera_index)];
      camera.images.push_back(image);
      camera.num_images = camera.images.size();
    }
  }
  for (pipeline::CameraCorners& camera : cameras) {
    std::sort(camera.images.begin(), camera.images.end(),
              [](const CameraView& a, const CameraView& b) { return a.stamp_ns < b.stamp_ns; });
  }
  return cameras;
}

std::optional<Guide::Solve> Guide::nextSolve(const std::function<bool()>& is_cancelled) {
  const bool is_due = num_changes_ >= std::max(kMinChanges, kept_.size() / kChangesPerView);
  for (std::size_t i = 0; i < coverage_.size(); ++i) {
    if (!is_due || numKept(static_cast<int>(i)) < options_.first_solve_views) {
      return std::nullopt;
    }
  }
  num_changes_ = 0;
  pipeline::CalibrateOptions options = options_.calibrate;
  options.num_threads = 1;  // detection goes on beside it
  return [corners = keptCorners(), target = target_, options, is_cancelled]() -> std::optional<calibration::Rig> {
    pipeline::Listener listener;
    listener.is_cancelled = is_cancelled;
    try {
      return pipeline::calibrateCorners(corners, target, options, listener).solution.rig;
    } catch (const Error&) {  // too few views yet, or stopped: the next one may succeed
      return std::nullopt;
    }
  };
}

Advice Guide::advise(const std::vector<SeenImage>& images) const {
  if (rig_) {
    return informedAdvice(images);
  }
  std::vector<CameraCollection> cameras;
  for (std::size_t i = 0; i < coverage_.size(); ++i) {
    if (!coverage_[i]) {
      return {"waiting for images of cam" + std::to_string(i), std::nullopt, 0.0};
    }
    cameras.push_back({*coverage_[i], {}});
  }
  std::vector<View> views;
  for (const KeptView& kept : kept_) {
    views.push_back(kept.view);
    for (const CameraView& image : kept.view.cameras) {
      if (const auto shape = boardShape(image.corners, target_points_)) {
        cameras[static_cast<std::size_t>(image.camera_index)].shapes.push_back(*shape);
      }
    }
  }
  const auto graph = calibration::cameraGraph(views, static_cast<int>(coverage_.size()));
  return {coverageAdvice(cameras, graph), std::nullopt, 0.0};
}

Advice Guide::informedAdvice(const std::vector<SeenImage>& images) const {
  constexpr double kEnough_ratio = 2.0;
  if (!best_candidate_ || best_gain_bits_ < kEnough_ratio * options_.min_gain_bits) {
    return {"enough views: calibrate", std::nullopt, best_gain_bits_};
  }
  const BoardCandidate& best = candidates_[*best_candidate_];
  const calibration::RigCamera& camera = rig_->cameras[static_cast<std::size_t>(best.camera_index)];
  const auto to = boardPlacement(camera, target_points_, best.T_rig_target);
  View seen;
  for (const SeenImage& image : images) {
    seen.cameras.push_back(cameraView(image));
  }
  const auto T_rig_target = boardPose(*rig_, target_points_, seen);
  const auto from = T_rig_target ? boardPlacement(camera, target_points_, *T_rig_target) : std::nullopt;
  const std::string name = coverage_.size() > 1 ? cameraName(best.camera_index) + ": " : "";
  return {name + (from ? moveAdvice(*from, *to, camera.camera) : placeAdvice(*to, camera.camera)), best, best_gain_bits_};
}

}  // namespace tartan_calib::guidance
