#include "tartan_calib/detection/corner_recovery.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "corner_candidate.h"
#include "corner_confirmation.h"
#include "quad_finder.h"
#include "quad_match.h"
#include "shift_field.h"
#include "tag_payload.h"
#include "tartan_calib/error.h"

namespace tartan_calib::detection {
namespace {

/// After the neighbours' shift is known, a missed corner is looked for this close to where they say.
constexpr double kSecondRadius_px = 1.5;
/// Opposite corners alternate in polarity; beyond this share of the distance to the next one the search could meet it.
constexpr double kMaxRadiusShare = 0.4;

/// Of the half-width in which the board is symmetric, for a template: the rest is for blur.
constexpr double kTemplateShare = 0.75;
/// Where something else begins within the window, such as the lens' rim or a hand, its inner part may do. It shows less,
/// which must look better.
constexpr double kInnerCorrelation = 0.9;

/// A window that is wider than the board is symmetric is not bounded in pixels, but for the time it takes.
constexpr double kWideWindow_px = 40.0;

/// TartanCalib's calls of cornerSubPix.
WindowRefineOptions tartanWindow(int half_window_px) {
  constexpr int kMaxIterations = 40;
  constexpr double kMinStep_px = 0.03;
  return {half_window_px, kMaxIterations, kMinStep_px, std::sqrt(2.0) * half_window_px};
}

/// Distance [px] from a corner to the nearest of its four neighbours on the lattice.
double nearestNeighbour(const std::vector<std::optional<Eigen::Vector2d>>& predicted, const target::Lattice& lattice,
                        int row, int col) {
  const auto at = [&](int r, int c) {
    const int corner_id = r * lattice.cols + c;
    return predicted[static_cast<std::size_t>(corner_id)];
  };
  double nearest_px = std::numeric_limits<double>::infinity();
  for (const auto& [dr, dc] : {std::pair(0, 1), std::pair(0, -1), std::pair(1, 0), std::pair(-1, 0)}) {
    const bool exists = row + dr >= 0 && row + dr < lattice.rows && col + dc >= 0 && col + dc < lattice.cols;
    if (exists && at(row + dr, col + dc)) {
      nearest_px = std::min(nearest_px, (*at(row + dr, col + dc) - *at(row, col)).norm());
    }
  }
  return nearest_px;
}

}  // namespace

CornerRecovery::CornerRecovery(const target::Target& target, const RecoveryOptions& options)
    : target_(target),
      options_(options),
      corner_points_(target::cornerPoints(target)),
      lattice_(target::cornerLattice(target)),
      neighbours_(target),
      half_window_m_(kTemplateShare * target::symmetricHalfWidth(target)) {
  if (const auto* grid = std::get_if<target::AprilGrid>(&target_)) {
    payload_ = std::make_shared<const TagPayload>(*grid);
  } else if (options.filter == CornerFilter::kQuads) {
    throw InputError("corners can be filtered by quadrilaterals on an AprilGrid only: leave out --corner-filter quads");
  }
}

std::vector<observation::Corner> CornerRecovery::recover(const cv::Mat& gray, const BoardMap& map) const {
  const bool on_quads = options_.filter == CornerFilter::kQuads;
  std::vector<CornerCandidate> candidates = on_quads ? recoverOnQuads(gray, map) : recoverCandidates(gray, map, 1);
  if (!on_quads && target::darkDiagonal(target_, 0) == 0) {
    // The print may be either way round; the wrong way finds nothing.
    const auto found = [](const CornerCandidate& candidate) { return candidate.isFound(); };
    std::vector<CornerCandidate> inverted = recoverCandidates(gray, map, -1);
    if (std::count_if(inverted.begin(), inverted.end(), found) >
        std::count_if(candidates.begin(), candidates.end(), found)) {
      candidates = std::move(inverted);
    }
  }
  std::vector<observation::Corner> corners;
  for (const CornerCandidate& candidate : candidates) {
    if (candidate.isFound()) {
      corners.push_back({candidate.corner_id, candidate.refined->px, candidate.refined->cov_px2, true});
    }
  }
  return corners;
}

std::vector<CornerCandidate> CornerRecovery::recoverCandidates(const cv::Mat& gray, const BoardMap& map,
                                                               int dark_diagonal) const {
  std::vector<CornerCandidate> candidates = predict(gray, map, dark_diagonal);
  for (CornerCandidate& candidate : candidates) {
    find(gray, map, Eigen::Vector2d::Zero(), options_.search_radius_px, candidate);
  }
  dropDeviating(options_.max_field_deviation_px, candidates);
  findAgain(gray, map, candidates);
  dropDeviating(options_.max_field_deviation_px, candidates);
  if (const auto* grid = std::get_if<target::AprilGrid>(&target_)) {
    dropUnconfirmed(gray, map, *grid, *payload_, candidates);
  }
  return candidates;
}

std::vector<CornerCandidate> CornerRecovery::recoverOnQuads(const cv::Mat& gray, const BoardMap& map) const {
  const auto& grid = std::get<target::AprilGrid>(target_);
  std::vector<std::optional<Eigen::Vector2d>> predicted_px;
  for (const Eigen::Vector3d& point : corner_points_) {
    predicted_px.push_back(map(point.head<2>()));
  }
  std::vector<CornerCandidate> candidates;
  for (const auto& [corner_id, px] : matchQuads(findQuads(gray), grid, predicted_px, options_.max_quad_distance_px)) {
    CornerCandidate candidate;
    candidate.corner_id = corner_id;
    candidate.refined = refine(gray, map, {corner_id, px});
    candidates.push_back(candidate);
  }
  return candidates;
}

std::vector<CornerCandidate> CornerRecovery::predict(const cv::Mat& gray, const BoardMap& map, int dark_diagonal) const {
  const double border = options_.min_border_px;
  const cv::Rect2d inside(border, border, gray.cols - 1 - 2.0 * border, gray.rows - 1 - 2.0 * border);
  std::vector<std::optional<Eigen::Vector2d>> predicted;
  for (const Eigen::Vector3d& point : corner_points_) {
    predicted.push_back(map(point.head<2>()));
  }
  std::vector<CornerCandidate> candidates;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    if (!predicted[i] || !inside.contains(cv::Point2d(predicted[i]->x(), predicted[i]->y()))) {
      continue;
    }
    CornerCandidate candidate;
    candidate.corner_id = static_cast<int>(i);
    candidate.row = candidate.corner_id / lattice_.cols;
    candidate.col = candidate.corner_id % lattice_.cols;
    candidate.neighbour_px = nearestNeighbour(predicted, lattice_, candidate.row, candidate.col);
    if (candidate.neighbour_px < options_.min_neighbour_px) {
      continue;
    }
    const int polarity = target::darkDiagonal(target_, candidate.corner_id);
    const int alternating = (candidate.row + candidate.col) % 2 == 0 ? dark_diagonal : -dark_diagonal;
    const auto expected =
        xCornerTemplate(map, corner_points_[i].head<2>(), half_window_m_, polarity != 0 ? polarity : alternating);
    if (expected) {
      candidate.expected = *expected;
      candidates.push_back(candidate);
    }
  }
  return candidates;
}

void CornerRecovery::find(const cv::Mat& gray, const BoardMap& map, const Eigen::Vector2d& expected_shift_px,
                          double radius_px, CornerCandidate& candidate) const {
  XCornerTemplate expected = candidate.expected;
  expected.px += expected_shift_px;
  const double radius = std::min(radius_px, kMaxRadiusShare * candidate.neighbour_px);
  findWithin(gray, map, {expected, radius, options_.min_correlation}, candidate);
  if (!candidate.isFound()) {
    const double min_correlation = std::max(options_.min_correlation, kInnerCorrelation);
    findWithin(gray, map, {innerTemplate(expected), radius, min_correlation}, candidate);
  }
}

void CornerRecovery::findWithin(const cv::Mat& gray, const BoardMap& map, const CornerSearch& search,
                                CornerCandidate& candidate) const {
  const auto match = searchXCorner(gray, search.expected, search.radius_px);
  if (!match || match->correlation < search.min_correlation || match->contrast < options_.min_contrast) {
    return;
  }
  const auto refined = refine(gray, map, {candidate.corner_id, match->px});
  if (refined) {
    candidate.match = match;
    candidate.refined = refined;
  }
}

std::optional<RefinedCorner> CornerRecovery::refine(const cv::Mat& gray, const BoardMap& map, const CornerSeed& seed) const {
  if (options_.refinement == Refinement::kFixed) {
    return refineInWindow(gray, seed.px, {});
  }
  if (options_.refinement == Refinement::kAdaptive) {
    const double nearest_px = neighbours_.nearest_px(map, seed.corner_id);
    return refineInWindow(gray, seed.px, tartanWindow(adaptiveHalfWindow(nearest_px, options_.adaptive_window)));
  }
  const Eigen::Vector2d corner_m = corner_points_[static_cast<std::size_t>(seed.corner_id)].head<2>();
  const auto origin_px = map(corner_m);
  const auto offset_map = [&](const Eigen::Vector2d& offset_m) -> Eigen::Vector2d {
    const auto px = map(corner_m + offset_m);
    return px && origin_px ? Eigen::Vector2d(*px - *origin_px)
                           : Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  };
  RefineOptions by_symmetry;
  by_symmetry.half_window = options_.symmetry_window * target::symmetricHalfWidth(target_);
  if (options_.symmetry_window > 1.0) {
    by_symmetry.may_shrink = false;
    by_symmetry.max_half_window_px = kWideWindow_px;
    by_symmetry.max_residual_ratio = std::numeric_limits<double>::infinity();
  }
  return refineBySymmetry(gray, seed.px, offset_map, by_symmetry);
}

void CornerRecovery::findAgain(const cv::Mat& gray, const BoardMap& map, std::vector<CornerCandidate>& candidates) const {
  std::vector<std::pair<std::size_t, Eigen::Vector2d>> missed;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].isFound()) {
      continue;
    }
    if (const auto shift_px = neighbourShift(candidates, i)) {
      missed.emplace_back(i, *shift_px);
    }
  }
  for (const auto& [index, shift_px] : missed) {
    find(gray, map, shift_px, kSecondRadius_px, candidates[index]);
  }
}

}  // namespace tartan_calib::detection
