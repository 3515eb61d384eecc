#include "corner_confirmation.h"

#include <algorithm>

#include "shift_field.h"
#include "tartan_calib/median.h"

namespace tartan_calib::detection {
namespace {

/// Without its payload a corner must look better than with it.
constexpr double kUnconfirmedCorrelation = 0.9;
/// A corner is as light as its neighbours: hands and glare are flatter.
constexpr double kMinContrastShare = 0.3;

std::size_t tagOf(const target::AprilGrid& grid, const CornerCandidate& candidate) {
  const int tag_index = (candidate.row / 2) * grid.tag_cols + candidate.col / 2;
  return static_cast<std::size_t>(tag_index);
}

/// By tag: what its payload shows where the found corners say that it is. One that sees this tag there is believed.
std::vector<PayloadVerdict> payloadVerdicts(const cv::Mat& gray, const BoardMap& map, const target::AprilGrid& grid,
                                            const TagPayload& payload, const std::vector<CornerCandidate>& candidates) {
  std::vector<PayloadVerdict> verdicts(static_cast<std::size_t>(target::numTags(grid)), PayloadVerdict::kUnclear);
  for (const CornerCandidate& candidate : candidates) {
    const std::size_t tag = tagOf(grid, candidate);
    if (!candidate.isFound() || verdicts[tag] == PayloadVerdict::kThisTag) {
      continue;
    }
    const PayloadVerdict verdict = payload.verdict(gray, map, static_cast<int>(tag), candidate.shift_px());
    if (verdict != PayloadVerdict::kUnclear) {
      verdicts[tag] = verdict;
    }
  }
  return verdicts;
}

}  // namespace

void dropUnconfirmed(const cv::Mat& gray, const BoardMap& map, const target::AprilGrid& grid, const TagPayload& payload,
                     std::vector<CornerCandidate>& candidates) {
  const std::vector<PayloadVerdict> verdicts = payloadVerdicts(gray, map, grid, payload, candidates);
  const auto verdict_of = [&](std::size_t i) { return verdicts[tagOf(grid, candidates[i])]; };
  const auto on_confirmed_tag = [&](std::size_t i) { return verdict_of(i) == PayloadVerdict::kThisTag; };
  std::vector<double> contrasts;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].isFound() && on_confirmed_tag(i)) {
      contrasts.push_back(candidates[i].match->contrast);
    }
  }
  const double least_contrast = contrasts.empty() ? 0.0 : kMinContrastShare * upperMedian(contrasts);
  std::vector<std::size_t> unconfirmed;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const CornerCandidate& candidate = candidates[i];
    if (!candidate.isFound()) {
      continue;
    }
    const bool vouched = verdict_of(i) == PayloadVerdict::kUnclear &&
                         candidate.match->correlation >= kUnconfirmedCorrelation &&
                         neighbourShift(candidates, i, on_confirmed_tag);
    if (candidate.match->contrast < least_contrast || (!on_confirmed_tag(i) && !vouched)) {
      unconfirmed.push_back(i);
    }
  }
  for (const std::size_t i : unconfirmed) {
    candidates[i].drop();
  }
}

}  // namespace tartan_calib::detection
