#include "painter.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace tartan_calib::guidance {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kReferenceWidth_px = 800.0;
constexpr double kScaleWidth_px = 260.0;  ///< of the scale of the heat and its text
constexpr double kHeat_ratio = 0.45;      ///< of the heat's colour, the rest is the image
constexpr double kEdge_px = 1.5;          ///< of dark around lines
constexpr int kSubpixelBits = 3;

}  // namespace

cv::Mat areaColours(const cv::Mat& levels) {
  cv::Mat bytes;
  levels.convertTo(bytes, CV_8U, 255.0);
  cv::Mat colours;
  cv::applyColorMap(bytes, colours, cv::COLORMAP_CIVIDIS);
  return colours;
}

cv::Mat lineColours(const cv::Mat& levels) {
  cv::Mat colours(levels.size(), CV_8UC3);
  for (int row = 0; row < levels.rows; ++row) {
    for (int col = 0; col < levels.cols; ++col) {
      const double level = 2.0 * std::clamp(static_cast<double>(levels.at<float>(row, col)), 0.0, 1.0);
      const cv::Scalar colour =
          level < 1.0 ? kSkyBlue * (1.0 - level) + kYellow * level : kYellow * (2.0 - level) + kVermillion * (level - 1.0);
      for (int channel = 0; channel < 3; ++channel) {
        colours.at<cv::Vec3b>(row, col)[channel] = cv::saturate_cast<unsigned char>(colour[channel]);
      }
    }
  }
  return colours;
}

cv::Scalar colourOf(Palette palette, double level) {
  const cv::Vec3b colour = palette(cv::Mat1f(1, 1, static_cast<float>(level))).at<cv::Vec3b>(0);
  return cv::Scalar(colour[0], colour[1], colour[2]);
}

Painter::Painter(const cv::Mat& gray, int max_width) {
  scale_ = std::min(1.0, static_cast<double>(max_width) / gray.cols);
  cv::Mat small;
  cv::resize(gray, small, {}, scale_, scale_, cv::INTER_AREA);
  cv::cvtColor(small, picture_, cv::COLOR_GRAY2BGR);
  constexpr double kMinUnit = 0.5;  // smaller letters cannot be read
  unit_ = std::max(kMinUnit, picture_.cols / kReferenceWidth_px);
}

void Painter::drawHeat(const cv::Mat& levels, const cv::Mat& is_there) {
  cv::Mat1f heat;
  cv::resize(levels, heat, picture_.size(), 0.0, 0.0, cv::INTER_LINEAR);
  cv::Mat1f weight;
  is_there.convertTo(weight, CV_32F, kHeat_ratio / 255.0);
  cv::resize(weight, weight, picture_.size(), 0.0, 0.0, cv::INTER_NEAREST);  // cells stay cells at the edge of the data
  const cv::Mat rest = 1.0 - weight;
  cv::blendLinear(areaColours(heat), picture_, weight, rest, picture_);
}

void Painter::drawRing(const Eigen::Vector2d& px, const cv::Scalar& colour) {
  constexpr double kRadius_px = 4.0;
  constexpr double kWidth_px = 1.5;
  for (const auto& [drawn, width] : {std::pair(kBlack, kWidth_px + kEdge_px), std::pair(colour, kWidth_px)}) {
    cv::circle(picture_, fixedPoint(px), pixels(kRadius_px) * (1 << kSubpixelBits), drawn, pixels(width), cv::LINE_AA,
               kSubpixelBits);
  }
}

void Painter::drawCross(const Eigen::Vector2d& px, const cv::Scalar& colour) {
  constexpr double kWidth_px = 2.0;
  const double reach_px = 6.0 * unit_ / scale_;
  const Eigen::Vector2d diagonal(reach_px, reach_px);
  const Eigen::Vector2d other(reach_px, -reach_px);
  drawLine({px - diagonal, px + diagonal}, kWidth_px, colour);
  drawLine({px - other, px + other}, kWidth_px, colour);
}

void Painter::drawLine(const std::vector<Eigen::Vector2d>& line, double width, const cv::Scalar& colour) {
  std::vector<cv::Point> points;
  points.reserve(line.size());
  for (const Eigen::Vector2d& px : line) {
    points.push_back(fixedPoint(px));
  }
  cv::polylines(picture_, points, false, kBlack, pixels(width + 2.0 * kEdge_px), cv::LINE_AA, kSubpixelBits);
  cv::polylines(picture_, points, false, colour, pixels(width), cv::LINE_AA, kSubpixelBits);
}

void Painter::drawHeadline(const std::string& text, double size, const cv::Scalar& colour) {
  const cv::Rect band = cv::Rect(0, 0, picture_.cols, bandHeight(size)) & cv::Rect({}, picture_.size());
  picture_(band).setTo(kBlack);
  writeIn(band, text, size, colour);
}

void Painter::addBand(const std::string& text, double size, const cv::Scalar& colour) {
  writeIn(addEmptyBand(size), text, size, colour);
}

void Painter::addBandWithScale(const std::string& text, Palette palette, const std::string& full_scale) {
  const cv::Rect band = addEmptyBand(kSmallText);
  const int scale_width_px = std::min(pixels(kScaleWidth_px), band.width / 2);
  const int scale_x_px = band.width - scale_width_px;
  const cv::Rect bar(scale_x_px, band.y + band.height / 4, scale_width_px / 2, band.height / 2);
  cv::Mat1f levels(1, 256);
  for (int i = 0; i < levels.cols; ++i) {
    levels(0, i) = static_cast<float>(i) / static_cast<float>(levels.cols - 1);
  }
  cv::resize(palette(levels), picture_(bar), bar.size(), 0.0, 0.0, cv::INTER_LINEAR);
  writeIn({bar.x + bar.width, band.y, band.width - bar.x - bar.width, band.height}, full_scale, kSmallText, kWhite);
  writeIn({0, band.y, scale_x_px, band.height}, text, kSmallText, kWhite);
}

cv::Rect Painter::addEmptyBand(double size) {
  const cv::Rect band(0, picture_.rows, picture_.cols, bandHeight(size));
  cv::copyMakeBorder(picture_, picture_, 0, band.height, 0, 0, cv::BORDER_CONSTANT, kBlack);
  return band;
}

int Painter::bandHeight(double size) const {
  constexpr double kLineHeight_px = 38.0;
  return pixels(kLineHeight_px * size);
}

void Painter::writeIn(const cv::Rect& band, const std::string& text, double size, const cv::Scalar& colour) {
  constexpr double kMargin_px = 10.0;
  constexpr double kThickness_px = 2.0;
  const int thickness = pixels(kThickness_px * size);
  const int margin_px = pixels(kMargin_px);
  const int room_px = std::max(1, band.width - 2 * margin_px);
  int baseline_px = 0;
  const cv::Size full = cv::getTextSize(text, kFont, size * unit_, thickness, &baseline_px);
  const double scale = size * unit_ * std::min(1.0, static_cast<double>(room_px) / std::max(1, full.width));
  cv::putText(picture_, text, {band.x + margin_px, band.y + band.height - band.height / 3}, kFont, scale, colour, thickness,
              cv::LINE_AA);
}

int Painter::pixels(double at_reference) const { return std::max(1, static_cast<int>(std::lround(at_reference * unit_))); }

cv::Point Painter::fixedPoint(const Eigen::Vector2d& px) const {
  constexpr double kFar_px = 1e5;  // that is within cv::Point also when shifted
  const Eigen::Array2d scaled_px = ((px.array() + 0.5) * scale_ - 0.5).min(kFar_px).max(-kFar_px);
  return {static_cast<int>(std::lround(std::ldexp(scaled_px.x(), kSubpixelBits))),
          static_cast<int>(std::lround(std::ldexp(scaled_px.y(), kSubpixelBits)))};
}

}  // namespace tartan_calib::guidance
