#include <algorithm>
#include <cmath>
#include <optional>

#include "bilinear.h"
#include "checkerboard_placement.h"
#include "detection_method.h"
#include "lattice_growth.h"
#include "lattice_map.h"
#include "tartan_calib/detection/lattice.h"
#include "tartan_calib/detection/refine.h"
#include "tartan_calib/detection/saddle.h"

namespace tartan_calib::detection {
namespace {

// Half side of the window of refinement, in squares: far enough from the next corners for their blur to stay outside. On
// rendered boards with small or blurred squares the error is half of that of the window of 0.2 that suits marker boards.
constexpr double kHalfWindowSquares = 0.3;
// Lattices with a smaller share of the board's corners are not tried to be extended to the whole board.
constexpr double kMinStart_ratio = 0.2;
// A corner without a saddle is looked for where its neighbours predict it, so far around [squares].
constexpr double kSearchSquares = 0.15;
// Grid of samples around a corner on which its squares are compared, and how alike they must be: 1 is a perfect corner,
// 0 something else. Noise of half of the contrast leaves 0.86.
constexpr int kSamplesPerSquare = 5;
constexpr double kSampleSpacingSquares = 0.06;
constexpr double kMinLikeness = 0.8;

/// One corner on its way from a guess to sub-pixel.
struct Guess {
  Eigen::Vector2d px;
  double max_shift_px;
  LatticeMap map;  ///< offset in (row, column) to pixels
};

class BoardRefiner {
 public:
  BoardRefiner(const cv::Mat& gray, const PlacedCorners& placed) : gray_(gray), placed_(placed) {
    for (const auto& [place, saddle] : placed.saddles) {
      seen_px_[place] = saddle.px;
    }
  }

  std::optional<RefinedCorner> refine(const LatticePlace& place, double max_shift_px) const {
    const auto saddle = placed_.saddles.find(place);
    const bool seen = saddle != placed_.saddles.end();
    const auto map = fitLatticeMap(seen_px_, place, seen);
    if (!map) {
      return std::nullopt;
    }
    const Guess guess = seen ? Guess{saddle->second.px, max_shift_px * saddle->second.scale_px, *map}
                             : Guess{map->centre_px(), kSearchSquares * map->minSpacing_px(), *map};
    const auto corner = refine(guess);
    return corner && likeness(place, corner->px, *map) > kMinLikeness ? corner : std::nullopt;
  }

 private:
  std::optional<RefinedCorner> refine(const Guess& guess) const {
    RefineOptions options;
    options.half_window = kHalfWindowSquares;
    options.max_shift_px = guess.max_shift_px;
    const auto offset_px = [&guess](const Eigen::Vector2d& offset) { return guess.map.offset_px(offset); };
    return refineBySymmetry(gray_, guess.px, offset_px, options);
  }

  /// Correlation, by signs, of the image around a corner with the squares that the board has there.
  double likeness(const LatticePlace& place, const Eigen::Vector2d& px, const LatticeMap& map) const {
    const double sign_ahead = placed_.dark_ahead == ((place.first + place.second) % 2 == 0) ? -1.0 : 1.0;
    std::vector<std::pair<double, double>> samples;  // sign of the square, grey value
    double mean = 0.0;
    for (int i = -kSamplesPerSquare; i <= kSamplesPerSquare; ++i) {
      for (int j = -kSamplesPerSquare; j <= kSamplesPerSquare; ++j) {
        const Eigen::Vector2d at = px + map.offset_px(kSampleSpacingSquares * Eigen::Vector2d(i, j));
        if (i == 0 || j == 0) {
          continue;
        }
        if (!canSample(gray_, at.x(), at.y())) {
          return 0.0;
        }
        samples.emplace_back(i * j > 0 ? sign_ahead : -sign_ahead, sampleBilinear(gray_, at.x(), at.y()));
        mean += samples.back().second;
      }
    }
    mean /= static_cast<double>(samples.size());
    double fitting = 0.0;
    double total = 0.0;
    for (const auto& [sign, grey] : samples) {
      fitting += sign * (grey - mean);
      total += std::abs(grey - mean);
    }
    return total > 0.0 ? fitting / total : 0.0;
  }

  const cv::Mat& gray_;
  const PlacedCorners& placed_;
  std::map<LatticePlace, Eigen::Vector2d> seen_px_;
};

bool isNearBorder(const cv::Mat& gray, const Eigen::Vector2d& px, double distance_px) {
  return px.minCoeff() < distance_px || px.x() > gray.cols - 1 - distance_px || px.y() > gray.rows - 1 - distance_px;
}

/// Lattices as large as they get. Where one has grown into another, only the first remains.
std::vector<SaddleLattice> findLattices(const cv::Mat& gray, const std::vector<Saddle>& saddles, std::size_t min_corners) {
  std::vector<bool> taken(saddles.size(), false);
  const auto is_taken = [&taken](const LatticeNode& node) { return taken[static_cast<std::size_t>(node.saddle_index)]; };
  std::vector<SaddleLattice> lattices;
  for (const SaddleLattice& start : growLattices(gray, saddles)) {
    const auto& nodes = start.nodes();
    if (nodes.size() < min_corners || std::any_of(nodes.begin(), nodes.end(), is_taken)) {
      continue;
    }
    lattices.push_back(extendLattice(gray, saddles, start));
    for (const LatticeNode& node : lattices.back().nodes()) {
      taken[static_cast<std::size_t>(node.saddle_index)] = true;
    }
  }
  return lattices;
}

struct FoundBoards {
  std::vector<PlacedCorners> placed;
  std::vector<BoardSize> other_sizes;
};

FoundBoards findBoards(const cv::Mat& gray, const target::Checkerboard& board) {
  const std::vector<Saddle> saddles = findSaddles(gray);
  const auto min_corners = static_cast<std::size_t>(kMinStart_ratio * board.rows * board.cols);
  FoundBoards found;
  for (const SaddleLattice& lattice : findLattices(gray, saddles, min_corners)) {
    if (!isRegular(lattice, saddles)) {
      continue;
    }
    if (auto placed = placeOnBoard(lattice, saddles, board)) {
      found.placed.push_back(std::move(*placed));
    } else if (const auto size = shownSize(lattice)) {
      found.other_sizes.push_back(*size);
    }
  }
  return found;
}

class CheckerboardMethod : public DetectionMethod {
 public:
  CheckerboardMethod(const target::Checkerboard& board, const DetectorOptions& options) : board_(board), options_(options) {}

  Detection detect(const cv::Mat& gray) const override {
    Detection detection;
    const FoundBoards found = findBoards(gray, board_);
    if (found.placed.empty() && found.other_sizes.size() == 1) {
      detection.counts.other_sizes[found.other_sizes.front()] = 1;
    }
    if (found.placed.size() != 1) {
      detection.counts.duplicate_tags = static_cast<int>(found.placed.size());
      return detection;
    }
    detection.counts.tags = 1;
    const BoardRefiner refiner(gray, found.placed.front());
    for (int row = 0; row < board_.rows; ++row) {
      for (int col = 0; col < board_.cols; ++col) {
        const auto corner = refiner.refine({row, col}, options_.max_refine_shift_px);
        if (corner && !isNearBorder(gray, corner->px, options_.min_border_distance_px)) {
          detection.corners.push_back({row * board_.cols + col, corner->px, corner->cov_px2});
        }
      }
    }
    return detection;
  }

 private:
  target::Checkerboard board_;
  DetectorOptions options_;
};

}  // namespace

std::unique_ptr<const DetectionMethod> makeCheckerboardMethod(const target::Checkerboard& board,
                                                              const DetectorOptions& options) {
  return std::make_unique<CheckerboardMethod>(board, options);
}

}  // namespace tartan_calib::detection
