#include "tartan_calib/detection/corner_recovery.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bilinear.h"
#include "tartan_calib/detection/refine.h"
#include "x_corner.h"

namespace tartan_calib::detection {
namespace {

/// Corners this far apart on the lattice vouch for each other's shift.
constexpr int kNeighbourhood = 3;
constexpr std::size_t kMinNeighbours = 2;
/// After the neighbours' shift is known, a missed corner is looked for this close to where they say.
constexpr double kSecondRadius_px = 1.5;
/// A wrong payload of 36 cells correlates by 0 +- 0.17.
constexpr double kConfirmingCorrelation = 0.5;
/// Without its payload a corner must look better than with it.
constexpr double kUnconfirmedCorrelation = 0.9;
/// A corner is as light as its neighbours: hands and glare are flatter.
constexpr double kMinContrastShare = 0.3;
/// Opposite corners alternate in polarity; beyond this share of the distance to the next one the search could meet it.
constexpr double kMaxRadiusShare = 0.4;

/// Pearson's correlation of pairs.
class Correlation {
 public:
  void add(double x, double y) {
    ++count_;
    x_ += x;
    y_ += y;
    xx_ += x * x;
    yy_ += y * y;
    xy_ += x * y;
  }
  double value() const {
    const double product = (count_ * xx_ - x_ * x_) * (count_ * yy_ - y_ * y_);
    return product > 0.0 ? (count_ * xy_ - x_ * y_) / std::sqrt(product) : 0.0;
  }

 private:
  double count_ = 0.0;
  double x_ = 0.0;
  double y_ = 0.0;
  double xx_ = 0.0;
  double yy_ = 0.0;
  double xy_ = 0.0;
};

/// Distance [px] from a corner to the nearest of its four neighbours on the lattice.
double nearestNeighbour(const std::vector<std::optional<Eigen::Vector2d>>& predicted, const target::Lattice& lattice,
                        int row, int col) {
  const auto at = [&](int r, int c) { return predicted[static_cast<std::size_t>(r * lattice.cols + c)]; };
  double nearest_px = std::numeric_limits<double>::infinity();
  for (const auto& [dr, dc] : {std::pair(0, 1), std::pair(0, -1), std::pair(1, 0), std::pair(-1, 0)}) {
    const bool exists = row + dr >= 0 && row + dr < lattice.rows && col + dc >= 0 && col + dc < lattice.cols;
    if (exists && at(row + dr, col + dc)) {
      nearest_px = std::min(nearest_px, (*at(row + dr, col + dc) - *at(row, col)).norm());
    }
  }
  return nearest_px;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

struct CornerRecovery::Candidate {
  int corner_id = -1;
  int row = 0;
  int col = 0;
  XCornerTemplate expected;
  double neighbour_px = 0.0;
  std::optional<XCornerMatch> match;  ///< set together with refined
  std::optional<RefinedCorner> refined;

  bool isFound() const { return refined.has_value(); }
  Eigen::Vector2d shift_px() const { return refined->px - expected.px; }
  void drop() {
    match.reset();
    refined.reset();
  }
};

namespace {

/// Component-wise median shift of the found corners around one, itself left out. Empty with too few of them.
template <typename Candidates, typename Accept>
std::optional<Eigen::Vector2d> neighbourShift(const Candidates& candidates, std::size_t index, const Accept& accept) {
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto& other = candidates[i];
    const int distance = std::max(std::abs(other.row - candidates[index].row), std::abs(other.col - candidates[index].col));
    if (i != index && distance <= kNeighbourhood && other.isFound() && accept(i)) {
      x.push_back(other.shift_px().x());
      y.push_back(other.shift_px().y());
    }
  }
  if (x.size() < kMinNeighbours) {
    return std::nullopt;
  }
  return Eigen::Vector2d(median(x), median(y));
}

bool acceptAll(std::size_t /*index*/) { return true; }

}  // namespace

CornerRecovery::CornerRecovery(const target::Target& target, const RecoveryOptions& options)
    : target_(target),
      options_(options),
      corner_points_(target::cornerPoints(target)),
      lattice_(target::cornerLattice(target)),
      half_window_m_(options.symmetry_window * target::symmetricHalfWidth(target)) {
  if (const auto* grid = std::get_if<target::AprilGrid>(&target_)) {
    family_ = target::tagFamily(grid->family);
  }
}

std::vector<observation::Corner> CornerRecovery::recover(const cv::Mat& gray, const BoardMap& map) const {
  std::vector<Candidate> candidates = recoverCandidates(gray, map, 1);
  if (target::darkDiagonal(target_, 0) == 0) {
    // The print may be either way round; the wrong way finds nothing.
    const auto found = [](const Candidate& candidate) { return candidate.isFound(); };
    std::vector<Candidate> inverted = recoverCandidates(gray, map, -1);
    if (std::count_if(inverted.begin(), inverted.end(), found) >
        std::count_if(candidates.begin(), candidates.end(), found)) {
      candidates = std::move(inverted);
    }
  }
  std::vector<observation::Corner> corners;
  for (const Candidate& candidate : candidates) {
    if (candidate.isFound()) {
      corners.push_back({candidate.corner_id, candidate.refined->px, candidate.refined->cov_px2, true});
    }
  }
  return corners;
}

std::vector<CornerRecovery::Candidate> CornerRecovery::recoverCandidates(const cv::Mat& gray, const BoardMap& map,
                                                                         int dark_diagonal) const {
  std::vector<Candidate> candidates = predict(gray, map, dark_diagonal);
  for (Candidate& candidate : candidates) {
    find(gray, map, Eigen::Vector2d::Zero(), options_.search_radius_px, candidate);
  }
  dropDeviating(candidates);
  findAgain(gray, map, candidates);
  dropDeviating(candidates);
  dropUnconfirmed(gray, map, candidates);
  return candidates;
}

std::vector<CornerRecovery::Candidate> CornerRecovery::predict(const cv::Mat& gray, const BoardMap& map,
                                                               int dark_diagonal) const {
  const double border = options_.min_border_px;
  const cv::Rect2d inside(border, border, gray.cols - 1 - 2.0 * border, gray.rows - 1 - 2.0 * border);
  std::vector<std::optional<Eigen::Vector2d>> predicted;
  for (const Eigen::Vector3d& point : corner_points_) {
    predicted.push_back(map(point.head<2>()));
  }
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    if (!predicted[i] || !inside.contains(cv::Point2d(predicted[i]->x(), predicted[i]->y()))) {
      continue;
    }
    Candidate candidate;
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
                          double radius_px, Candidate& candidate) const {
  XCornerTemplate expected = candidate.expected;
  expected.px += expected_shift_px;
  const double radius = std::min(radius_px, kMaxRadiusShare * candidate.neighbour_px);
  const auto match = searchXCorner(gray, expected, radius);
  if (!match || match->correlation < options_.min_correlation || match->contrast < options_.min_contrast) {
    return;
  }
  const Eigen::Vector2d corner_m = corner_points_[static_cast<std::size_t>(candidate.corner_id)].head<2>();
  const Eigen::Vector2d origin_px = candidate.expected.px;
  const auto offset_map = [&](const Eigen::Vector2d& offset_m) -> Eigen::Vector2d {
    const auto px = map(corner_m + offset_m);
    return px ? Eigen::Vector2d(*px - origin_px) : Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  };
  RefineOptions refine;
  refine.half_window = half_window_m_;
  const auto refined = refineBySymmetry(gray, match->px, offset_map, refine);
  if (refined) {
    candidate.match = match;
    candidate.refined = refined;
  }
}

void CornerRecovery::dropDeviating(std::vector<Candidate>& candidates) const {
  std::vector<std::size_t> deviating;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!candidates[i].isFound()) {
      continue;
    }
    const auto shift_px = neighbourShift(candidates, i, acceptAll);
    if (!shift_px || (candidates[i].shift_px() - *shift_px).norm() > options_.max_field_deviation_px) {
      deviating.push_back(i);
    }
  }
  for (const std::size_t i : deviating) {
    candidates[i].drop();
  }
}

void CornerRecovery::findAgain(const cv::Mat& gray, const BoardMap& map, std::vector<Candidate>& candidates) const {
  std::vector<std::pair<std::size_t, Eigen::Vector2d>> missed;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].isFound()) {
      continue;
    }
    if (const auto shift_px = neighbourShift(candidates, i, acceptAll)) {
      missed.emplace_back(i, *shift_px);
    }
  }
  for (const auto& [index, shift_px] : missed) {
    find(gray, map, shift_px, kSecondRadius_px, candidates[index]);
  }
}

void CornerRecovery::dropUnconfirmed(const cv::Mat& gray, const BoardMap& map, std::vector<Candidate>& candidates) const {
  const auto* grid = std::get_if<target::AprilGrid>(&target_);
  if (grid == nullptr) {
    return;
  }
  std::vector<bool> confirmed(static_cast<std::size_t>(target::numTags(*grid)), false);
  const auto tagOf = [&](const Candidate& c) { return static_cast<std::size_t>((c.row / 2) * grid->tag_cols + c.col / 2); };
  for (const Candidate& candidate : candidates) {
    const std::size_t tag = tagOf(candidate);
    if (candidate.isFound() && !confirmed[tag]) {
      confirmed[tag] = payloadCorrelation(gray, map, static_cast<int>(tag), candidate.shift_px()) > kConfirmingCorrelation;
    }
  }
  std::vector<double> contrasts;
  for (const Candidate& candidate : candidates) {
    if (candidate.isFound() && confirmed[tagOf(candidate)]) {
      contrasts.push_back(candidate.match->contrast);
    }
  }
  const double least_contrast = contrasts.empty() ? 0.0 : kMinContrastShare * median(contrasts);
  std::vector<std::size_t> unconfirmed;
  const auto onConfirmedTag = [&](std::size_t i) { return confirmed[tagOf(candidates[i])]; };
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    if (!candidate.isFound()) {
      continue;
    }
    const bool vouched =
        candidate.match->correlation >= kUnconfirmedCorrelation && neighbourShift(candidates, i, onConfirmedTag);
    if (candidate.match->contrast < least_contrast || (!onConfirmedTag(i) && !vouched)) {
      unconfirmed.push_back(i);
    }
  }
  for (const std::size_t i : unconfirmed) {
    candidates[i].drop();
  }
}

double CornerRecovery::payloadCorrelation(const cv::Mat& gray, const BoardMap& map, int tag_index,
                                          const Eigen::Vector2d& shift_px) const {
  const auto& grid = std::get<target::AprilGrid>(target_);
  const int cells = family_.payload_cells + 2 * grid.border_cells;
  const double cell_m = grid.tag_size_m / cells;
  const std::vector<int> corner_ids = target::tagCornerIds(grid, tag_index);
  const Eigen::Vector2d top_left_m = corner_points_[static_cast<std::size_t>(corner_ids[3])].head<2>();
  Correlation correlation;
  for (int row = 0; row < family_.payload_cells; ++row) {
    for (int col = 0; col < family_.payload_cells; ++col) {
      const Eigen::Vector2d offset_m((grid.border_cells + col + 0.5) * cell_m, -(grid.border_cells + row + 0.5) * cell_m);
      const auto px = map(top_left_m + offset_m);
      const Eigen::Vector2d at = px ? Eigen::Vector2d(*px + shift_px) : Eigen::Vector2d::Constant(-1.0);
      if (canSample(gray, at.x(), at.y())) {
        const bool white = target::isWhiteCell(family_, grid.code_offset + tag_index, row, col);
        correlation.add(sampleBilinear<std::uint8_t>(gray, at.x(), at.y()), white ? 1.0 : -1.0);
      }
    }
  }
  return correlation.value();
}

}  // namespace tartan_calib::detection
