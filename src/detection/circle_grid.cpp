#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "detection_method.h"

namespace tartan_calib::detection {
namespace {

// OpenCV's limit of 5000 px per circle is for small images: a circle takes up to this share of its part of the image.
constexpr double kMaxCircleArea_ratio = 0.5;

using Centres = std::vector<cv::Point2f>;

/// Centres by row and column of a grid.
class OrderedCentres {
 public:
  OrderedCentres(int rows, int cols, Centres centres) : rows_(rows), cols_(cols), centres_(std::move(centres)) {}

  const cv::Point2f& at(int row, int col) const { return centres_[static_cast<std::size_t>(row * cols_ + col)]; }

  OrderedCentres transposed() const {
    return reordered(cols_, rows_, [this](int row, int col) { return at(col, row); });
  }
  OrderedCentres withColumnsReversed() const {
    return reordered(rows_, cols_, [this](int row, int col) { return at(row, cols_ - 1 - col); });
  }
  /// Rows 1, 0, 3, 2 ...; their number is even.
  OrderedCentres withRowsSwapped() const {
    return reordered(rows_, cols_, [this](int row, int col) { return at(row ^ 1, col); });
  }

  /// True if columns turn clockwise into rows as the image is seen.
  bool isClockwise() const {
    const cv::Point2f falling = at(rows_ - 1, cols_ - 1) - at(0, 0);
    const cv::Point2f rising = at(0, cols_ - 1) - at(rows_ - 1, 0);
    return rising.cross(falling) > 0.0F;
  }

  /// True if every row lies between the ones before and after it.
  bool hasRowsInOrder() const {
    for (int row = 1; row + 1 < rows_; ++row) {
      for (int col = 0; col < cols_; ++col) {
        // Rows of an asymmetric grid are shifted by turns: the row before and the row after lie in line.
        const cv::Point2f before_after = at(row + 1, col) - at(row - 1, col);
        const double along = (at(row, col) - at(row - 1, col)).dot(before_after) / before_after.dot(before_after);
        if (!(along > 0.0 && along < 1.0)) {
          return false;
        }
      }
    }
    return true;
  }

 private:
  template <typename CentreAt>
  static OrderedCentres reordered(int rows, int cols, const CentreAt& centre_at) {
    Centres centres;
    for (int row = 0; row < rows; ++row) {
      for (int col = 0; col < cols; ++col) {
        centres.push_back(centre_at(row, col));
      }
    }
    return {rows, cols, std::move(centres)};
  }

  int rows_;
  int cols_;
  Centres centres_;
};

class CircleGridMethod : public DetectionMethod {
 public:
  CircleGridMethod(const target::CircleGrid& grid, const DetectorOptions& options) : grid_(grid), options_(options) {}

  Detection detect(const cv::Mat& gray) const override {
    Detection detection;
    const auto centres = grid_.asymmetric ? findAsymmetric(gray) : findSymmetric(gray);
    if (!centres || !centres->hasRowsInOrder()) {
      return detection;
    }
    const double border_px = options_.min_border_distance_px;
    const cv::Rect2d inside(border_px, border_px, gray.cols - 1 - 2.0 * border_px, gray.rows - 1 - 2.0 * border_px);
    for (int id = 0; id < grid_.rows * grid_.cols; ++id) {
      const cv::Point2f& px = centres->at(id / grid_.cols, id % grid_.cols);
      if (inside.contains(px)) {
        observation::Corner corner;
        corner.corner_id = id;
        corner.px = {px.x, px.y};
        detection.corners.push_back(corner);
      }
    }
    return detection;
  }

 private:
  std::optional<OrderedCentres> find(const cv::Mat& gray, int rows, int cols) const {
    cv::SimpleBlobDetector::Params params;
    const double part_px2 = static_cast<double>(gray.total()) / (rows * cols);
    params.maxArea = std::max(params.maxArea, static_cast<float>(kMaxCircleArea_ratio * part_px2));
    const int flags = grid_.asymmetric ? cv::CALIB_CB_ASYMMETRIC_GRID : cv::CALIB_CB_SYMMETRIC_GRID;
    Centres centres;
    if (!cv::findCirclesGrid(gray, cv::Size(cols, rows), centres, flags, cv::SimpleBlobDetector::create(params))) {
      return std::nullopt;
    }
    return OrderedCentres(rows, cols, std::move(centres));
  }

  /// OpenCV finds rows only where they are more or less level.
  std::optional<OrderedCentres> findSymmetric(const cv::Mat& gray) const {
    auto centres = find(gray, grid_.rows, grid_.cols);
    if (!centres && grid_.rows != grid_.cols) {
      const auto turned = find(gray, grid_.cols, grid_.rows);
      centres = turned ? std::optional<OrderedCentres>(turned->transposed()) : std::nullopt;
    }
    return centres && !centres->isClockwise() ? centres->withColumnsReversed() : centres;
  }

  /// OpenCV swaps the rows of each pair of a grid with an even number of them in half of all orientations.
  std::optional<OrderedCentres> findAsymmetric(const cv::Mat& gray) const {
    auto centres = find(gray, grid_.rows, grid_.cols);
    const bool swapped = centres && grid_.rows % 2 == 0 && !centres->hasRowsInOrder();
    return swapped ? centres->withRowsSwapped() : centres;
  }

  target::CircleGrid grid_;
  DetectorOptions options_;
};

}  // namespace

std::unique_ptr<const DetectionMethod> makeCircleGridMethod(const target::CircleGrid& grid, const DetectorOptions& options) {
  return std::make_unique<CircleGridMethod>(grid, options);
}

}  // namespace tartan_calib::detection
