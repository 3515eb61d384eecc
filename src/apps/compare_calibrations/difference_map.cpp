#include "compare_calibrations/difference_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/image_plot.h"
#include "common/picture_file.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

constexpr double kSmallest_px = 1e-6;  ///< no differences at all are drawn to this scale

ImageField differenceField(const camera::Camera& camera, const calibration::ProjectionDifference& projection) {
  const std::vector<Eigen::Vector2d> grid = calibration::imageGrid(camera.width, camera.height, kSampleSpacing_px);
  const auto index = [](double first, double px) { return static_cast<int>(std::lround((px - first) / kSampleSpacing_px)); };
  ImageField field;
  field.first_px = grid.front();
  field.spacing_px = kSampleSpacing_px;
  field.values = cv::Mat1f(index(grid.front().y(), grid.back().y()) + 1, index(grid.front().x(), grid.back().x()) + 1,
                           std::numeric_limits<float>::quiet_NaN());
  for (const calibration::PixelDifference& pixel : projection.pixels) {
    field.values(index(field.first_px.y(), pixel.px.y()), index(field.first_px.x(), pixel.px.x())) =
        static_cast<float>(pixel.difference_px.norm());
  }
  return field;
}

/// A multiple of a tenth or more of the value, so that nearly all colours of the scale are used.
double scaleEnd(double value) {
  constexpr double kStep = 0.1;
  const double step = roundUp(kStep * value);
  return step * std::ceil(value / step);
}

/// Nearly all differences of all cameras are below.
double largestOf(const RigComparison& comparison) {
  constexpr double kShare = 0.99;
  std::vector<double> lengths_px;
  for (const CameraComparison& camera : comparison.cameras) {
    for (const calibration::PixelDifference& pixel : camera.projection.pixels) {
      lengths_px.push_back(pixel.difference_px.norm());
    }
  }
  std::sort(lengths_px.begin(), lengths_px.end());
  const auto position = static_cast<std::size_t>(kShare * static_cast<double>(lengths_px.size() - 1));
  return scaleEnd(std::max(kSmallest_px, lengths_px[position]));
}

/// 1-2-5 numbers below `largest`, the largest few.
std::vector<double> contourLevels(double largest) {
  constexpr std::size_t kNumLevels = 4;
  constexpr double kNext = 0.4;  // rounds up to the next smaller 1-2-5 number
  std::vector<double> levels;
  for (double level = roundUp(largest); levels.size() < kNumLevels;) {
    level = roundUp(kNext * level);
    levels.push_back(level);
  }
  return levels;
}

}  // namespace

cv::Mat differenceMap(const io::Camchain& a, const io::Camchain& b, const ComparisonRegion& region,
                      const RigComparison& comparison) {
  const double largest = largestOf(comparison);
  std::vector<cv::Mat> pictures;
  for (std::size_t i = 0; i < comparison.cameras.size(); ++i) {
    const camera::Camera& camera = a.rig.cameras[i].camera;
    const calibration::ProjectionDifference& projection = comparison.cameras[i].projection;
    const ImageField field = differenceField(camera, projection);
    ImagePlot plot(cameraName(i) + ": difference of the projections, " + camera::modelName(camera.model) + " and " +
                       camera::modelName(b.rig.cameras[i].camera.model),
                   camera.width, camera.height);
    plot.drawField(field, largest, "px");
    plot.drawContours(field, contourLevels(largest), largest);
    plot.drawNote(format("rms %.4f px, largest %.4f px; %s removed; grey: not compared", projection.rms_px,
                         projection.max_px,
                         region.distance_m ? format("motion at %g m", *region.distance_m).c_str() : "rotation"));
    pictures.push_back(plot.picture());
  }
  return arrange(pictures);
}

}  // namespace tartan_calib::apps
