#include "validate_calibration/error_picture.h"

#include <algorithm>
#include <cmath>

#include "common/image_plot.h"
#include "common/picture_file.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

constexpr double kSmallest_px = 1e-6;  ///< no errors at all are drawn to this scale

/// Lengths of all errors that count, sorted.
std::vector<double> sortedLengths(const Validation& validation) {
  std::vector<double> lengths_px;
  for (const CameraValidation& camera : validation.cameras) {
    for (const calibration::ImageErrors& image : camera.images) {
      for (const calibration::CornerError& corner : image.corners) {
        if (!corner.is_wrong) {
          lengths_px.push_back(corner.error_px.norm());
        }
      }
    }
  }
  std::sort(lengths_px.begin(), lengths_px.end());
  return lengths_px;
}

cv::Mat cameraPicture(const CameraValidation& camera, int camera_index, double largest_px) {
  constexpr double kLongest = 0.025;  // of the image's width
  ImagePlot plot(cameraName(camera_index) + ": measured minus predicted corners", camera.camera.width, camera.camera.height);
  const double magnification = roundUp(kLongest * camera.camera.width / largest_px);
  plot.drawColourBar(largest_px, "px");
  for (const calibration::ImageErrors& image : camera.images) {
    for (const calibration::CornerError& corner : image.corners) {
      if (!corner.is_wrong) {
        plot.drawVector(corner.px, corner.error_px, magnification, ImagePlot::colourOf(corner.error_px.norm() / largest_px));
      }
    }
  }
  plot.drawNote(format("rms %.4f px, 95 %% below %.4f px, %d corners in %d images; lines are %g times as long",
                       camera.together.errors.rms_px, camera.together.errors.percentile95_px,
                       camera.together.errors.num_corners, camera.together.num_images, magnification));
  return plot.picture();
}

}  // namespace

cv::Mat errorPicture(const Validation& validation) {
  constexpr double kShare = 0.95;  // of the errors are within the scale of colours
  const std::vector<double> lengths_px = sortedLengths(validation);
  const auto position = static_cast<std::size_t>(kShare * static_cast<double>(lengths_px.size()));
  const double largest_px = roundUp(
      lengths_px.empty() ? kSmallest_px : std::max(kSmallest_px, lengths_px[std::min(position, lengths_px.size() - 1)]));
  std::vector<cv::Mat> pictures;
  for (std::size_t i = 0; i < validation.cameras.size(); ++i) {
    pictures.push_back(cameraPicture(validation.cameras[i], static_cast<int>(i), largest_px));
  }
  return arrange(pictures);
}

}  // namespace tartan_calib::apps
