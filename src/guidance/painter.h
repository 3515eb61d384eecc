#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace tartan_calib::guidance {

// Blue, green, red. Of Wong's palette for colour-blind readers (Nature Methods 2011).
inline const cv::Scalar kVermillion(0, 94, 213);
inline const cv::Scalar kSkyBlue(233, 180, 86);
inline const cv::Scalar kYellow(66, 228, 240);
inline const cv::Scalar kWhite(255, 255, 255);
inline const cv::Scalar kBlack(0, 0, 0);

/// Sizes of text, as factors.
constexpr double kLargeText = 0.9;
constexpr double kSmallText = 0.55;

/// Colours of levels (CV_32FC1, 0 to 1), CV_8UC3. For areas: cividis, dark to bright. For lines with a dark edge: bright
/// throughout, from blue over yellow to red.
using Palette = cv::Mat (*)(const cv::Mat& levels);
cv::Mat areaColours(const cv::Mat& levels);
cv::Mat lineColours(const cv::Mat& levels);

/// Colour of a single level.
cv::Scalar colourOf(Palette palette, double level);

/// Draws over a picture of an image that is scaled down to a largest width. Positions are in pixels of the image, sizes in
/// those of a picture 800 px wide. Lines have a dark edge, so that they show on any ground.
class Painter {
 public:
  Painter(const cv::Mat& gray, int max_width);

  cv::Mat picture() const { return picture_; }

  /// Colours a map of levels from 0 to 1 (CV_32FC1) over the whole picture where `is_there` (CV_8UC1, 0 or 255).
  void drawHeat(const cv::Mat& levels, const cv::Mat& is_there);

  void drawRing(const Eigen::Vector2d& px, const cv::Scalar& colour);
  void drawCross(const Eigen::Vector2d& px, const cv::Scalar& colour);
  void drawLine(const std::vector<Eigen::Vector2d>& line, double width, const cv::Scalar& colour);

  /// A line of text over the upper edge of the picture. Long lines are written smaller.
  void drawHeadline(const std::string& text, double size, const cv::Scalar& colour);

  /// The same on a band below the picture, which grows by it.
  void addBand(const std::string& text, double size, const cv::Scalar& colour);

  /// The same in small letters, with the colours from 0 to 1 at its right end and what 1 stands for.
  void addBandWithScale(const std::string& text, Palette palette, const std::string& full_scale);

 private:
  cv::Rect addEmptyBand(double size);
  int bandHeight(double size) const;
  void writeIn(const cv::Rect& band, const std::string& text, double size, const cv::Scalar& colour);
  int pixels(double at_reference) const;
  cv::Point fixedPoint(const Eigen::Vector2d& px) const;

  cv::Mat picture_;  ///< CV_8UC3
  double scale_ = 1.0;
  double unit_ = 1.0;  ///< size of drawn things against those at the reference width
};

}  // namespace tartan_calib::guidance
