#include "shift_field.h"

#include <algorithm>
#include <cstdlib>

#include "tartan_calib/median.h"

namespace tartan_calib::detection {
namespace {

/// Corners this far apart on the lattice vouch for each other's shift.
constexpr int kNeighbourhood = 3;
constexpr std::size_t kMinNeighbours = 2;

}  // namespace

std::optional<Eigen::Vector2d> neighbourShift(const std::vector<CornerCandidate>& candidates, std::size_t index,
                                              const std::function<bool(std::size_t)>& counts) {
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const CornerCandidate& other = candidates[i];
    const int distance = std::max(std::abs(other.row - candidates[index].row), std::abs(other.col - candidates[index].col));
    if (i != index && distance <= kNeighbourhood && other.isFound() && counts(i)) {
      x.push_back(other.shift_px().x());
      y.push_back(other.shift_px().y());
    }
  }
  if (x.size() < kMinNeighbours) {
    return std::nullopt;
  }
  return Eigen::Vector2d(upperMedian(x), upperMedian(y));
}

void dropDeviating(double max_deviation_px, std::vector<CornerCandidate>& candidates) {
  std::vector<std::size_t> deviating;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!candidates[i].isFound()) {
      continue;
    }
    const auto shift_px = neighbourShift(candidates, i);
    if (!shift_px || (candidates[i].shift_px() - *shift_px).norm() > max_deviation_px) {
      deviating.push_back(i);
    }
  }
  for (const std::size_t i : deviating) {
    candidates[i].drop();
  }
}

}  // namespace tartan_calib::detection
