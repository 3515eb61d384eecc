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

// Half side of the window of refinement, in squares: accuracy grows with it until the lens bends the squares too much.
constexpr double kHalfWindow_squares = 0.2;
// A corner without a saddle is looked for where its neighbours predict it, so far around [squares].
constexpr double kSearch_squares = 0.15;
// Where the squares around a corner are compared, from the corner along both axes [squares].
constexpr double kProbe_squares = 0.25;
constexpr double kMinProbeContrast = 8.0;  // [grey levels]

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
    if (seen) {
      return refine({saddle->second.px, max_shift_px * saddle->second.scale_px, *map});
    }
    const auto found = refine({map->centre_px(), kSearch_squares * map->minSpacing_px(), *map});
    return found && showsSquares(place, found->px, *map) ? found : std::nullopt;
  }

 private:
  std::optional<RefinedCorner> refine(const Guess& guess) const {
    RefineOptions options;
    options.half_window = kHalfWindow_squares;
    options.max_shift_px = guess.max_shift_px;
    const auto offset_px = [&guess](const Eigen::Vector2d& offset) { return guess.map.offset_px(offset); };
    return refineBySymmetry(gray_, guess.px, offset_px, options);
  }

  /// True if the four squares around a corner have the shades that the board says.
  bool showsSquares(const LatticePlace& place, const Eigen::Vector2d& px, const LatticeMap& map) const {
    const bool dark_ahead = placed_.dark_ahead == ((place.first + place.second) % 2 == 0);
    double darkest_light = 255.0;
    double lightest_dark = 0.0;
    for (const double row : {-kProbe_squares, kProbe_squares}) {
      for (const double column : {-kProbe_squares, kProbe_squares}) {
        const Eigen::Vector2d probe = px + map.offset_px({row, column});
        if (!canSample(gray_, probe.x(), probe.y())) {
          return false;
        }
        const double grey = sampleBilinear<std::uint8_t>(gray_, probe.x(), probe.y());
        if ((row * column > 0.0) == dark_ahead) {
          lightest_dark = std::max(lightest_dark, grey);
        } else {
          darkest_light = std::min(darkest_light, grey);
        }
      }
    }
    return darkest_light - lightest_dark > kMinProbeContrast;
  }

  const cv::Mat& gray_;
  const PlacedCorners& placed_;
  std::map<LatticePlace, Eigen::Vector2d> seen_px_;
};

bool isNearBorder(const cv::Mat& gray, const Eigen::Vector2d& px, double distance_px) {
  return px.minCoeff() < distance_px || px.x() > gray.cols - 1 - distance_px || px.y() > gray.rows - 1 - distance_px;
}

std::vector<PlacedCorners> findBoards(const cv::Mat& gray, const target::Checkerboard& board) {
  const std::vector<Saddle> saddles = findSaddles(gray);
  std::vector<PlacedCorners> boards;
  for (const SaddleLattice& lattice : growLattices(gray, saddles)) {
    if (static_cast<int>(lattice.nodes().size()) < board.rows * board.cols / 4) {
      break;
    }
    if (auto placed = placeOnBoard(extendLattice(gray, saddles, lattice), saddles, board)) {
      boards.push_back(std::move(*placed));
    }
  }
  return boards;
}

class CheckerboardMethod : public DetectionMethod {
 public:
  CheckerboardMethod(const target::Checkerboard& board, const DetectorOptions& options) : board_(board), options_(options) {}

  Detection detect(const cv::Mat& gray) const override {
    Detection detection;
    const std::vector<PlacedCorners> boards = findBoards(gray, board_);
    if (boards.size() != 1) {
      detection.counts.duplicate_tags = static_cast<int>(boards.size());
      return detection;
    }
    detection.counts.tags = 1;
    const BoardRefiner refiner(gray, boards.front());
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
