#include "common/image_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

constexpr int kOversampling = 2;
constexpr int kLongSide = kOversampling * 760;  ///< of the area of the image
constexpr int kLeftMargin = kOversampling * 64;
constexpr int kTopMargin = kOversampling * 46;
constexpr int kRightMargin = kOversampling * 104;
constexpr int kBottomMargin = kOversampling * 70;
constexpr int kGap = kOversampling * 6;
constexpr int kTick = kOversampling * 5;
constexpr int kBarWidth = kOversampling * 18;
constexpr int kLine = kOversampling;
constexpr double kTitleSize = kOversampling * 0.6;
constexpr double kTextSize = kOversampling * 0.45;
constexpr int kNumTicks = 6;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;

const cv::Scalar kBlack(0, 0, 0);
const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kNoValue(200, 200, 200);

enum class Align { kLeft, kCentre, kRight };

cv::Size sizeOf(const std::string& text, double size) { return cv::getTextSize(text, kFont, size, kLine, nullptr); }

/// `where`: the middle of the text's height.
void write(cv::Mat& canvas, const std::string& text, const cv::Point& where, Align align, double size = kTextSize,
           const cv::Scalar& colour = kBlack) {
  const cv::Size extent = sizeOf(text, size);
  const int left = align == Align::kLeft ? 0 : align == Align::kCentre ? extent.width / 2 : extent.width;
  cv::putText(canvas, text, {where.x - left, where.y + extent.height / 2}, kFont, size, colour, kLine, cv::LINE_AA);
}

std::string numberText(double value) { return format("%g", value); }

constexpr int kMaxLevel = 255;

/// Viridis of amounts from 0 to 1, CV_8UC3.
cv::Mat coloured(const cv::Mat& amounts) {
  cv::Mat levels;
  amounts.convertTo(levels, CV_8U, kMaxLevel);
  cv::Mat colours;
  cv::applyColorMap(levels, colours, cv::COLORMAP_VIRIDIS);
  return colours;
}

/// Viridis in a row, from level 0 to kMaxLevel.
cv::Mat3b viridis() {
  cv::Mat1f amounts(1, kMaxLevel + 1);
  for (int level = 0; level <= kMaxLevel; ++level) {
    amounts(0, level) = static_cast<float>(level) / kMaxLevel;
  }
  return coloured(amounts);
}

/// CV_8U mask of the NaN.
cv::Mat withoutValue(const cv::Mat1f& amounts) {
  cv::Mat1b mask(amounts.size());
  std::transform(amounts.begin(), amounts.end(), mask.begin(), [](float amount) { return std::isnan(amount) ? 255 : 0; });
  return mask;
}

/// The upper colours are light.
cv::Scalar inkOn(double share) {
  constexpr double kLightFrom = 0.6;
  return share > kLightFrom ? kBlack : kWhite;
}

/// Distance of each place from the line where the field has the level, in pixels; NaN next to places without value.
cv::Mat1f distanceToLevel(const cv::Mat1f& field, double level) {
  cv::Mat1f distance(field.size(), std::numeric_limits<float>::quiet_NaN());
  for (int y = 1; y + 1 < field.rows; ++y) {
    for (int x = 1; x + 1 < field.cols; ++x) {
      const float du = 0.5F * (field(y, x + 1) - field(y, x - 1));
      const float dv = 0.5F * (field(y + 1, x) - field(y - 1, x));
      const float slope = std::max(std::hypot(du, dv), std::numeric_limits<float>::min());
      distance(y, x) = std::abs(field(y, x) - static_cast<float>(level)) / slope;
    }
  }
  return distance;
}

/// A place on the line for its number, nearest to the right of and below the centre; empty where `is_taken` covers all.
std::optional<cv::Point> labelPlace(const cv::Mat1f& distance, const cv::Mat1b& is_taken) {
  constexpr float kOnLine = 0.7F;
  const cv::Point2d wanted(0.8 * distance.cols, 0.75 * distance.rows);
  std::optional<cv::Point> best;
  double best_distance = std::numeric_limits<double>::infinity();
  const int margin = 2 * kLeftMargin / 3;
  for (int y = kGap * 2; y < distance.rows - kGap * 2; ++y) {
    for (int x = margin; x < distance.cols - margin; ++x) {
      const double away = cv::norm(cv::Point2d(x, y) - wanted);
      if (distance(y, x) < kOnLine && is_taken(y, x) == 0 && away < best_distance) {
        best = cv::Point(x, y);
        best_distance = away;
      }
    }
  }
  return best;
}

/// Where the middle of a label of this size would lie over a place of the mask.
cv::Mat1b around(const cv::Mat& mask, const cv::Size& label) {
  cv::Mat1b result;
  cv::dilate(mask, result, cv::getStructuringElement(cv::MORPH_RECT, label));
  return result;
}

void drawLine(const cv::Mat1f& distance, const cv::Scalar& ink, cv::Mat area) {
  constexpr float kHalfWidth = 0.6F * kOversampling;
  for (int y = 0; y < distance.rows; ++y) {
    for (int x = 0; x < distance.cols; ++x) {
      if (distance(y, x) < kHalfWidth + 1.0F) {
        const float share = std::min(1.0F, kHalfWidth + 1.0F - distance(y, x));
        cv::Vec3b& pixel = area.at<cv::Vec3b>(y, x);
        for (int c = 0; c < 3; ++c) {
          pixel[c] = cv::saturate_cast<uchar>((1.0F - share) * pixel[c] + share * static_cast<float>(ink[c]));
        }
      }
    }
  }
}

}  // namespace

double roundUp(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= value * (1.0 - 1e-9)) {
      return digit * power;
    }
  }
  return 10.0 * power;
}

ImagePlot::ImagePlot(const std::string& title, int image_width, int image_height)
    : image_width_(image_width),
      image_height_(image_height),
      scale_(static_cast<double>(kLongSide) / std::max(image_width, image_height)) {
  const cv::Size size(static_cast<int>(std::lround(scale_ * image_width)),
                      static_cast<int>(std::lround(scale_ * image_height)));
  canvas_ = cv::Mat(kTopMargin + size.height + kBottomMargin, kLeftMargin + size.width + kRightMargin, CV_8UC3, kWhite);
  write(canvas_, title, {kLeftMargin, kTopMargin / 2}, Align::kLeft, kTitleSize);
  cv::rectangle(canvas_, area(), kBlack, kLine);
  drawTicks();
}

cv::Rect ImagePlot::area() const {
  return {kLeftMargin, kTopMargin, canvas_.cols - kLeftMargin - kRightMargin, canvas_.rows - kTopMargin - kBottomMargin};
}

/// Pixel (-0.5, -0.5) is the upper left corner of the area.
cv::Point2d ImagePlot::at(const Eigen::Vector2d& px) const {
  return {kLeftMargin + scale_ * (px.x() + 0.5), kTopMargin + scale_ * (px.y() + 0.5)};
}

void ImagePlot::drawTicks() {
  const double step_px = roundUp(std::max(image_width_, image_height_) / static_cast<double>(kNumTicks));
  for (double u = 0.0; u < image_width_; u += step_px) {
    const cv::Point foot(static_cast<int>(at({u, 0.0}).x), area().br().y);
    cv::line(canvas_, foot, {foot.x, foot.y + kTick}, kBlack, kLine);
    write(canvas_, numberText(u), {foot.x, foot.y + kTick + 2 * kGap}, Align::kCentre);
  }
  for (double v = 0.0; v < image_height_; v += step_px) {
    const cv::Point foot(kLeftMargin, static_cast<int>(at({0.0, v}).y));
    cv::line(canvas_, foot, {foot.x - kTick, foot.y}, kBlack, kLine);
    write(canvas_, numberText(v), {foot.x - kTick - kGap, foot.y}, Align::kRight);
  }
  write(canvas_, "u, v [px]", {area().br().x, area().br().y + kTick + 2 * kGap}, Align::kLeft);
}

cv::Mat1f ImagePlot::resampled(const ImageField& field) const {
  const cv::Point2d first = at(field.first_px);
  cv::Mat1f map_x(area().size());
  cv::Mat1f map_y(area().size());
  const double step = scale_ * field.spacing_px;
  for (int y = 0; y < map_x.rows; ++y) {
    for (int x = 0; x < map_x.cols; ++x) {
      map_x(y, x) = static_cast<float>((x + kLeftMargin - first.x) / step);
      map_y(y, x) = static_cast<float>((y + kTopMargin - first.y) / step);
    }
  }
  cv::Mat1f result;
  cv::remap(field.values, result, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return result;
}

void ImagePlot::drawField(const ImageField& field, double largest, const std::string& label) {
  const cv::Mat1f amounts = resampled(field);
  cv::Mat target = canvas_(area());
  coloured(amounts / largest).copyTo(target);
  target.setTo(kNoValue, withoutValue(amounts));
  cv::rectangle(canvas_, area(), kBlack, kLine);
  drawColourBar(largest, label);
}

/// From a table: applyColorMap computes its own anew in every call.
cv::Scalar ImagePlot::colourOf(double share) {
  static const cv::Mat3b table = viridis();
  const auto level = cv::saturate_cast<uchar>(kMaxLevel * std::clamp(share, 0.0, 1.0));
  const cv::Vec3b& colour = table(0, level);
  return {static_cast<double>(colour[0]), static_cast<double>(colour[1]), static_cast<double>(colour[2])};
}

void ImagePlot::drawColourBar(double largest, const std::string& label) {
  constexpr int kNumSteps = 5;
  const cv::Rect bar(area().br().x + 2 * kGap, kTopMargin, kBarWidth, area().height);
  cv::Mat1f amounts(bar.size());
  for (int y = 0; y < bar.height; ++y) {
    amounts.row(y).setTo(1.0 - (y + 0.5) / bar.height);
  }
  coloured(amounts).copyTo(canvas_(bar));
  cv::rectangle(canvas_, bar, kBlack, kLine);
  for (int i = 0; i <= kNumSteps; ++i) {
    const int y = bar.br().y - i * bar.height / kNumSteps;
    cv::line(canvas_, {bar.br().x, y}, {bar.br().x + kTick, y}, kBlack, kLine);
    write(canvas_, numberText(largest * i / kNumSteps), {bar.br().x + kTick + kGap, y}, Align::kLeft);
  }
  write(canvas_, label, {canvas_.cols - kGap, kTopMargin / 2}, Align::kRight);
}

void ImagePlot::drawContours(const ImageField& field, const std::vector<double>& levels, double largest) {
  const cv::Mat1f amounts = resampled(field);
  cv::Mat target = canvas_(area());
  std::vector<cv::Mat1f> distances;
  std::vector<cv::Mat> lines;
  for (const double level : levels) {
    distances.push_back(distanceToLevel(amounts, level));
    lines.emplace_back(distances.back() < 1.0F);
    drawLine(distances.back(), inkOn(level / largest), target);
  }
  cv::Mat labels = cv::Mat::zeros(target.size(), CV_8U);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::string text = numberText(levels[i]);
    const cv::Size extent = sizeOf(text, kTextSize) + cv::Size(kGap, kGap);
    cv::Mat taken = labels.clone();
    for (std::size_t other = 0; other < levels.size(); ++other) {
      taken.setTo(255, other == i ? labels : lines[other]);
    }
    std::optional<cv::Point> place = labelPlace(distances[i], around(taken, extent));
    if (!place) {
      place = labelPlace(distances[i], around(labels, extent));
    }
    if (place) {
      const cv::Rect box = cv::Rect(*place - cv::Point(extent / 2), extent) & cv::Rect({0, 0}, target.size());
      const double share = levels[i] / largest;
      target(box).setTo(colourOf(share));
      write(target, text, *place, Align::kCentre, kTextSize, inkOn(share));
      labels(box).setTo(255);
    }
  }
}

void ImagePlot::drawVector(const Eigen::Vector2d& from_px, const Eigen::Vector2d& vector_px, double magnification,
                           const cv::Scalar& colour) {
  cv::Mat target = canvas_(area());
  const cv::Point origin(kLeftMargin, kTopMargin);
  const cv::Point from = cv::Point(at(from_px)) - origin;
  const cv::Point to = cv::Point(at(from_px + magnification * vector_px)) - origin;
  cv::line(target, from, to, colour, kLine, cv::LINE_AA);
  cv::circle(target, from, kLine, colour, cv::FILLED, cv::LINE_AA);
}

void ImagePlot::drawNote(const std::string& text) {
  write(canvas_, text, {kLeftMargin, canvas_.rows - 3 * kGap}, Align::kLeft);
}

cv::Mat ImagePlot::picture() const {
  cv::Mat shown;
  cv::resize(canvas_, shown, canvas_.size() / kOversampling, 0.0, 0.0, cv::INTER_AREA);
  return shown;
}

}  // namespace tartan_calib::apps
