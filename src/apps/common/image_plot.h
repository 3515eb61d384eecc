#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace tartan_calib::apps {

/// Amounts over a camera's image on a regular grid; NaN where there is none.
struct ImageField {
  cv::Mat1f values;
  Eigen::Vector2d first_px = Eigen::Vector2d::Zero();  ///< pixel of values(0, 0)
  double spacing_px = 1.0;
};

/// 1, 2 or 5 times a power of ten, not below `value`.
double roundUp(double value);

/// A drawing over the area of a camera's image, with title and ticks in pixels. Everything is given in pixels of the image.
class ImagePlot {
 public:
  ImagePlot(const std::string& title, int image_width, int image_height);

  /// Viridis from 0 to `largest`, grey where the field has no value, with a bar that says so and `label`.
  void drawField(const ImageField& field, double largest, const std::string& label);

  /// The bar alone, for what is drawn in colourOf.
  void drawColourBar(double largest, const std::string& label);

  /// Viridis at a share of its largest amount.
  static cv::Scalar colourOf(double share);

  /// Lines of equal amounts, each with its number.
  void drawContours(const ImageField& field, const std::vector<double>& levels, double largest);

  /// `magnification` times as long as it is in pixels of the image.
  void drawVector(const Eigen::Vector2d& from_px, const Eigen::Vector2d& vector_px, double magnification,
                  const cv::Scalar& colour);

  /// A line of text below the drawing.
  void drawNote(const std::string& text);

  cv::Mat picture() const;

 private:
  cv::Point2d at(const Eigen::Vector2d& px) const;
  cv::Rect area() const;
  void drawTicks();
  cv::Mat1f resampled(const ImageField& field) const;

  int image_width_;
  int image_height_;
  double scale_;    ///< pixels of the canvas per pixel of the image
  cv::Mat canvas_;  ///< drawn larger than shown, so that lines are smooth
};

}  // namespace tartan_calib::apps
