#include "tartan_calib/guidance/overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tartan_calib/text.h"

namespace tartan_calib::guidance {
namespace {

// Blue, green, red. Wong's palette for colour-blind readers (Nature Methods 2011), and two greys.
const cv::Scalar kVermillion(0, 94, 213);
const cv::Scalar kSkyBlue(233, 180, 86);
const cv::Scalar kYellow(66, 228, 240);
const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kBlack(0, 0, 0);

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kReferenceWidth_px = 800.0;  ///< at which sizes below are meant
constexpr double kFullHeat_corners = 20.0;    ///< in a cell: more makes no difference to a calibration
constexpr double kLegendWidth_px = 260.0;
constexpr double kHeat_ratio = 0.45;  ///< of the heat map where there are corners
constexpr int kSubpixelBits = 3;

class Painter {
 public:
  Painter(const cv::Mat& gray, int max_width) {
    scale_ = std::min(1.0, static_cast<double>(max_width) / gray.cols);
    cv::Mat small;
    cv::resize(gray, small, {}, scale_, scale_, cv::INTER_AREA);
    cv::cvtColor(small, image_, cv::COLOR_GRAY2BGR);
    unit_ = std::max(0.5, image_.cols / kReferenceWidth_px);
  }

  cv::Mat image() const { return image_; }

  void drawHeat(const CoverageMap& coverage) {
    cv::Mat1f heat;
    coverage.counts().convertTo(heat, CV_32F, 1.0 / kFullHeat_corners);
    cv::Mat1f weight;
    cv::Mat(coverage.counts() > 0).convertTo(weight, CV_32F, kHeat_ratio / 255.0);
    cv::resize(heat, heat, image_.size(), 0.0, 0.0, cv::INTER_LINEAR);
    cv::resize(weight, weight, image_.size(), 0.0, 0.0, cv::INTER_NEAREST);  // cells stay cells where nothing is
    cv::Mat levels;
    heat.convertTo(levels, CV_8U, 255.0);
    cv::Mat colours;
    cv::applyColorMap(levels, colours, cv::COLORMAP_CIVIDIS);
    cv::blendLinear(colours, image_, weight, 1.0 - weight, image_);
  }

  void drawCorners(const std::vector<observation::Corner>& corners) {
    for (const observation::Corner& corner : corners) {
      const cv::Point at = fixedPoint(corner.px);
      cv::circle(image_, at, pixels(4.0) << kSubpixelBits, kBlack, pixels(3.0), cv::LINE_AA, kSubpixelBits);
      cv::circle(image_, at, pixels(4.0) << kSubpixelBits, kSkyBlue, pixels(1.5), cv::LINE_AA, kSubpixelBits);
    }
  }

  void drawOutline(const std::vector<std::vector<Eigen::Vector2d>>& lines) {
    for (const auto& [colour, width] : {std::pair(kBlack, 7.0), std::pair(kVermillion, 4.0)}) {
      for (const std::vector<Eigen::Vector2d>& line : lines) {
        std::vector<cv::Point> points;
        for (const Eigen::Vector2d& px : line) {
          points.push_back(fixedPoint(px));
        }
        cv::polylines(image_, points, false, colour, pixels(width), cv::LINE_AA, kSubpixelBits);
      }
    }
  }

  /// A line of text on a dark band below the picture, which grows by it. Long lines are written smaller.
  void addBand(const std::string& text, double size, const cv::Scalar& colour) {
    const int top_px = image_.rows;
    cv::copyMakeBorder(image_, image_, 0, bandHeight(size), 0, 0, cv::BORDER_CONSTANT, kBlack);
    writeIn({0, top_px, image_.cols, bandHeight(size)}, text, size, colour);
  }

  /// The same over the upper edge of the picture.
  void drawBand(const std::string& text, double size, const cv::Scalar& colour) {
    const cv::Rect band = cv::Rect(0, 0, image_.cols, bandHeight(size)) & cv::Rect({}, image_.size());
    image_(band).setTo(kBlack);
    writeIn(band, text, size, colour);
  }

  /// What the heat means, at the right end of the last band.
  void drawLegend(double size) {
    const int height_px = bandHeight(size);
    const cv::Rect band(image_.cols - pixels(kLegendWidth_px), image_.rows - height_px, pixels(kLegendWidth_px), height_px);
    cv::Mat1b levels(1, 256);
    for (int i = 0; i < levels.cols; ++i) {
      levels(0, i) = static_cast<unsigned char>(i);
    }
    cv::Mat colours;
    cv::applyColorMap(levels, colours, cv::COLORMAP_CIVIDIS);
    const cv::Rect bar(band.x, band.y + height_px / 4, band.width / 2, height_px / 2);
    cv::resize(colours, image_(bar), bar.size(), 0.0, 0.0, cv::INTER_LINEAR);
    const cv::Rect right(bar.x + bar.width, band.y, band.width - bar.width, height_px);
    writeIn(right, format("%.0f+ corners", kFullHeat_corners), size, kWhite);
  }

 private:
  int bandHeight(double size) const { return pixels(38.0 * size); }

  void writeIn(const cv::Rect& band, const std::string& text, double size, const cv::Scalar& colour) {
    int baseline_px = 0;
    double scale = size * unit_;
    const int thickness = pixels(2.0 * size);
    const int margin_px = pixels(10.0);
    const cv::Size full = cv::getTextSize(text, kFont, scale, thickness, &baseline_px);
    scale *= std::min(1.0, (band.width - 2.0 * margin_px) / std::max(1, full.width));
    const cv::Point at(band.x + margin_px, band.y + band.height - band.height / 3);
    cv::putText(image_, text, at, kFont, scale, colour, thickness, cv::LINE_AA);
  }

  int pixels(double at_reference) const { return std::max(1, static_cast<int>(std::lround(at_reference * unit_))); }

  cv::Point fixedPoint(const Eigen::Vector2d& px) const {
    constexpr double kFar = 1e6;  // within cv::Point also when shifted
    const Eigen::Vector2d scaled = ((px.array() + 0.5) * scale_ - 0.5).cwiseMin(kFar).cwiseMax(-kFar);
    return {static_cast<int>(std::lround(std::ldexp(scaled.x(), kSubpixelBits))),
            static_cast<int>(std::lround(std::ldexp(scaled.y(), kSubpixelBits)))};
  }

  cv::Mat image_;
  double scale_ = 1.0;
  double unit_ = 1.0;  ///< size of drawn things against those at the reference width
};

}  // namespace

cv::Mat drawOverlay(const cv::Mat& gray, const Overlay& overlay, int max_width) {
  constexpr double kLarge = 0.9;
  constexpr double kSmall = 0.55;
  Painter painter(gray, max_width);
  if (overlay.coverage != nullptr) {
    painter.drawHeat(*overlay.coverage);
  }
  painter.drawOutline(overlay.outline);
  painter.drawCorners(overlay.corners);
  if (!overlay.warning.empty()) {
    painter.drawBand(overlay.warning, kLarge, kYellow);
  }
  painter.addBand(overlay.advice, kLarge, kWhite);
  painter.addBand(overlay.status, kSmall, kWhite);
  if (overlay.coverage != nullptr) {
    painter.drawLegend(kSmall);
  }
  return painter.image();
}

}  // namespace tartan_calib::guidance
