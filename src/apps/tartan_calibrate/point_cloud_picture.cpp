#include "tartan_calibrate/point_cloud_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace tartan_calib::apps {
namespace {

constexpr int kPanel_px = 640;
constexpr int kTitle_px = 40;
constexpr double kUsedShare = 0.9;  ///< of a panel's half width, by the farthest point
constexpr double kAxisShare = 3.0;  ///< the farthest point over the length of the drawn axes, at least
constexpr double kTextScale = 0.5;

const cv::Scalar kBlack(0.0, 0.0, 0.0);
const cv::Scalar kGrey(120.0, 120.0, 120.0);

/// A side from which the points are seen: camera coordinates to the right and down in its panel.
struct Side {
  const char* title;
  Eigen::Vector3d right;
  Eigen::Vector3d down;
};

/// Seen from behind, above and the right of the camera; turned enough to tell all three axes apart.
const std::array<Side, 3> kSides = {{{"oblique", {0.87, 0.0, -0.5}, {0.25, 0.87, 0.43}},
                                     {"from above: x right, z up", {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}},
                                     {"from the right: z right, y down", {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}}}};

const std::array<cv::Scalar, 3> kAxisColours = {
    {cv::Scalar(0.0, 0.0, 200.0), cv::Scalar(0.0, 140.0, 0.0), cv::Scalar(200.0, 0.0, 0.0)}};
constexpr std::array kAxisNames = {"x", "y", "z"};

double reach(const std::vector<CloudPoint>& points) {
  double largest = 0.0;
  for (const CloudPoint& point : points) {
    largest = std::max(largest, point.p_cam.norm());
  }
  return largest > 0.0 ? largest : 1.0;
}

/// The largest of 1, 2 and 5 times a power of ten that is not above.
double roundLength(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  const double share = length / power;
  return power * (share >= 5.0 ? 5.0 : share >= 2.0 ? 2.0 : 1.0);
}

/// One side's picture in the making; the camera is in its middle.
class Panel {
 public:
  Panel(const Side& side, double px_per_unit)
      : side_(side), px_per_unit_(px_per_unit), picture_(kPanel_px, kPanel_px, CV_8UC3, cv::Scalar::all(255.0)) {}

  void drawAxes(double length, const std::string& label) {
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const cv::Point end = place(length * Eigen::Vector3d::Unit(i));
      cv::arrowedLine(picture_, place(Eigen::Vector3d::Zero()), end, kAxisColours[k], 2, cv::LINE_AA);
      cv::putText(picture_, kAxisNames[k], end + cv::Point(4, 4), cv::FONT_HERSHEY_SIMPLEX, kTextScale, kAxisColours[k], 1,
                  cv::LINE_AA);
    }
    cv::putText(picture_, label, {8, kPanel_px - 10}, cv::FONT_HERSHEY_SIMPLEX, kTextScale, kGrey, 1, cv::LINE_AA);
  }

  void draw(const CloudPoint& point) { cv::circle(picture_, place(point.p_cam), 1, point.colour, cv::FILLED); }

  const cv::Mat& picture() const { return picture_; }

 private:
  cv::Point place(const Eigen::Vector3d& p_cam) const {
    constexpr double kMiddle_px = 0.5 * kPanel_px;
    return {static_cast<int>(std::lround(kMiddle_px + px_per_unit_ * side_.right.dot(p_cam))),
            static_cast<int>(std::lround(kMiddle_px + px_per_unit_ * side_.down.dot(p_cam)))};
  }

  const Side& side_;
  double px_per_unit_;
  cv::Mat picture_;
};

std::string lengthText(double length, const std::string& unit) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "camera's axes: %g %s", length, unit.c_str());
  return text.data();
}

}  // namespace

cv::Scalar sequenceColour(std::size_t index, std::size_t count) {
  const double share = count > 1 ? static_cast<double>(index) / static_cast<double>(count - 1) : 0.0;
  return {255.0 * (1.0 - share), 160.0 * (1.0 - std::abs(2.0 * share - 1.0)), 255.0 * share};
}

cv::Mat drawPointCloud(const std::vector<CloudPoint>& points, const std::string& unit) {
  const double extent = reach(points);
  const double axis_length = roundLength(extent / kAxisShare);
  const int num_sides = static_cast<int>(kSides.size());
  cv::Mat picture(kPanel_px + kTitle_px, kPanel_px * num_sides, CV_8UC3, cv::Scalar::all(255.0));
  for (int i = 0; i < num_sides; ++i) {
    const Side& side = kSides[static_cast<std::size_t>(i)];
    Panel panel(side, kUsedShare * 0.5 * kPanel_px / extent);
    for (const CloudPoint& point : points) {
      panel.draw(point);
    }
    panel.drawAxes(axis_length, lengthText(axis_length, unit));
    const cv::Rect place(i * kPanel_px, kTitle_px, kPanel_px, kPanel_px);
    panel.picture().copyTo(picture(place));
    cv::rectangle(picture, place, kGrey);
    cv::putText(picture, side.title, {place.x + 8, kTitle_px - 14}, cv::FONT_HERSHEY_SIMPLEX, kTextScale, kBlack, 1,
                cv::LINE_AA);
  }
  return picture;
}

}  // namespace tartan_calib::apps
