#include "tartan_calib/report/analysis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "tartan_calib/calibration/compare.h"
#include "tartan_calib/calibration/intrinsics_uncertainty.h"
#include "tartan_calib/report/cross_validation.h"
#include "tartan_calib/report/uncertainty.h"

namespace tartan_calib::report {
namespace {

constexpr double kMapColumns = 48.0;
constexpr std::size_t kMaxAligned = 2000;  ///< corners that the motion between two calibrations is fitted to
constexpr double kBandWidth_rad = M_PI / 18.0;
constexpr double kMargin_rad = M_PI / 90.0;  ///< beyond the farthest corner that a model may be trusted
constexpr double kSeenShare = 0.98;          ///< of the seen map that counts for its reach

/// Brightness of a frame's pixels below which they show nothing: a share of what bright ones have, but above the noise.
constexpr double kDark_ratio = 0.1;
constexpr double kMinDarkGrey = 16.0;
constexpr double kBrightShare = 0.9;

/// Lenses that reach no farther than this at the nearest edge of the image light all of it.
constexpr double kNarrow_rad = M_PI / 3.0;

double quantile(std::vector<double> values, double share) {
  if (values.empty()) {
    return 0.0;
  }
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Which pixels of the image show something in any picture. Without pictures: all of a narrow lens's, of a wide lens's those
/// within the circle that touches the nearest edge of the image.
class SeenPixels {
 public:
  SeenPixels(const camera::Camera& camera, const CameraPictures* pictures) : camera_(camera) {
    if (pictures != nullptr && !pictures->brightest.empty()) {
      brightest_ = pictures->brightest;
      const std::vector<double> values(brightest_.begin<unsigned char>(), brightest_.end<unsigned char>());
      dark_grey_ = std::max(kMinDarkGrey, kDark_ratio * quantile(values, kBrightShare));
    }
    const double right_px = camera.width - 1.0;
    const double bottom_px = camera.height - 1.0;
    for (const Eigen::Vector2d& edge_px :
         {Eigen::Vector2d(0.0, 0.5 * bottom_px), Eigen::Vector2d(right_px, 0.5 * bottom_px),
          Eigen::Vector2d(0.5 * right_px, 0.0), Eigen::Vector2d(0.5 * right_px, bottom_px)}) {
      circle_rad_ = std::min(circle_rad_, polarAngle(camera.model, edge_px).value_or(circle_rad_));
    }
  }

  bool contains(const MapSample& sample) const {
    if (brightest_.empty()) {
      return sample.polar_rad && (circle_rad_ < kNarrow_rad || *sample.polar_rad <= circle_rad_);
    }
    const auto cell = [](double px, int size, int cells) {
      return std::clamp(static_cast<int>((px + 0.5) * cells / size), 0, cells - 1);
    };
    return brightest_.at<unsigned char>(cell(sample.px.y(), camera_.height, brightest_.rows),
                                        cell(sample.px.x(), camera_.width, brightest_.cols)) >= dark_grey_;
  }

 private:
  const camera::Camera& camera_;
  cv::Mat brightest_;
  double dark_grey_ = 0.0;
  double circle_rad_ = M_PI;
};

ProjectionMap emptyMap(const camera::Camera& camera, const SeenPixels& seen) {
  ProjectionMap map;
  for (const Eigen::Vector2d& px : calibration::imageGrid(camera.width, camera.height, camera.width / kMapColumns)) {
    map.cols += px.y() == (map.samples.empty() ? px.y() : map.samples.front().px.y()) ? 1 : 0;
    MapSample sample;
    sample.px = px;
    sample.polar_rad = polarAngle(camera.model, px);
    sample.is_seen = seen.contains(sample);
    map.samples.push_back(sample);
  }
  map.rows = static_cast<int>(map.samples.size()) / map.cols;
  return map;
}

/// Places of the used corners, evenly chosen where there are many.
std::vector<Eigen::Vector2d> dataPixels(const SeenCorners& corners) {
  std::vector<Eigen::Vector2d> all;
  for (const FoundCorner& corner : corners.found) {
    if (corner.used) {
      all.push_back(corner.px);
    }
  }
  const std::size_t step = (all.size() + kMaxAligned - 1) / kMaxAligned;
  std::vector<Eigen::Vector2d> chosen;
  for (std::size_t i = 0; i < all.size(); i += step) {
    chosen.push_back(all[i]);
  }
  return chosen;
}

std::vector<std::optional<double>> stdevsOverMap(const calibration::Solution& solution, int camera_index,
                                                 const CameraAnalysis& camera) {
  std::vector<Eigen::Vector2d> samples_px;
  for (const MapSample& sample : camera.map.samples) {
    samples_px.push_back(sample.px);
  }
  return projectionStdevs(solution, camera_index, dataPixels(camera.corners), samples_px);
}

void addUncertainty(const calibration::Solution& solution, int camera_index, CameraAnalysis& camera) {
  const auto stdevs_px = stdevsOverMap(solution, camera_index, camera);
  for (std::size_t i = 0; i < stdevs_px.size(); ++i) {
    camera.map.samples[i].stdev_px = stdevs_px[i];
  }
  camera.focal_stdev_ratio = calibration::focalStdevRatio(solution, camera_index);
}

void addDifference(const std::array<calibration::Solution, 2>& halves, int camera_index, CameraAnalysis& camera) {
  const auto at = static_cast<std::size_t>(camera_index);
  const camera::CameraModel& even = halves[0].rig.cameras[at].camera.model;
  const camera::CameraModel& odd = halves[1].rig.cameras[at].camera.model;
  const calibration::ProjectionDifference aligned = calibration::compareProjections(even, odd, dataPixels(camera.corners));
  const auto even_stdevs_px = stdevsOverMap(halves[0], camera_index, camera);
  const auto odd_stdevs_px = stdevsOverMap(halves[1], camera_index, camera);
  for (std::size_t i = 0; i < camera.map.samples.size(); ++i) {
    MapSample& sample = camera.map.samples[i];
    const auto ray = camera::unproject(even, sample.px);
    const auto odd_px = ray ? camera::project(odd, aligned.T_b_a * *ray) : std::nullopt;
    if (odd_px) {
      sample.difference_px = (*odd_px - sample.px).norm();
    }
    if (even_stdevs_px[i] && odd_stdevs_px[i]) {
      sample.expected_difference_px = std::hypot(*even_stdevs_px[i], *odd_stdevs_px[i]);
    }
  }
}

bool isTrusted(const MapSample& sample, double max_polar_rad) {
  return sample.polar_rad && *sample.polar_rad <= max_polar_rad;
}

/// Median over the samples within reach of the corners; empty where none has the value.
std::optional<double> trustedMedian(const ProjectionMap& map, double max_polar_rad,
                                    std::optional<double> MapSample::*value) {
  std::vector<double> values;
  for (const MapSample& sample : map.samples) {
    if (isTrusted(sample, max_polar_rad) && sample.*value) {
      values.push_back(*(sample.*value));
    }
  }
  return values.empty() ? std::nullopt : std::make_optional(quantile(values, 0.5));
}

void addMedians(double max_polar_rad, CameraAnalysis& camera) {
  const auto median = [&](auto value) { return trustedMedian(camera.map, max_polar_rad, value); };
  camera.median_stdev_px = median(&MapSample::stdev_px).value_or(0.0);
  camera.median_difference_px = median(&MapSample::difference_px);
  camera.median_expected_difference_px = median(&MapSample::expected_difference_px).value_or(0.0);
}

void addReach(double max_polar_rad, CameraAnalysis& camera) {
  std::vector<double> polar_rad;
  int num_seen = 0;
  int num_beyond = 0;
  for (const MapSample& sample : camera.map.samples) {
    if (sample.is_seen) {
      ++num_seen;
      num_beyond += isTrusted(sample, max_polar_rad + kMargin_rad) ? 0 : 1;
      polar_rad.push_back(sample.polar_rad.value_or(max_polar_rad));
    }
  }
  camera.reach_rad = std::max(max_polar_rad, quantile(polar_rad, kSeenShare));
  camera.extrapolated_ratio = static_cast<double>(num_beyond) / std::max(1, num_seen);
}

/// Ninths of the image that the lens sees but that hold no corner.
void addEmptyRegions(const camera::Camera& camera, CameraAnalysis& analysis) {
  constexpr double kMinSeen = 0.5;
  const std::array<const char*, 9> names = {"upper left", "top",        "upper right", "left",       "centre",
                                            "right",      "lower left", "bottom",      "lower right"};
  struct Ninth {
    int num_samples = 0;
    int num_seen = 0;
    int num_corners = 0;
  };
  std::array<Ninth, 9> ninths;
  const auto ninth = [&](const Eigen::Vector2d& px) -> Ninth& {
    const int col = std::clamp(static_cast<int>(3.0 * (px.x() + 0.5) / camera.width), 0, 2);
    const int row = std::clamp(static_cast<int>(3.0 * (px.y() + 0.5) / camera.height), 0, 2);
    return ninths[static_cast<std::size_t>(3 * row + col)];
  };
  for (const MapSample& sample : analysis.map.samples) {
    ++ninth(sample.px).num_samples;
    ninth(sample.px).num_seen += sample.is_seen ? 1 : 0;
  }
  for (const FoundCorner& corner : analysis.corners.found) {
    ninth(corner.px).num_corners += corner.used ? 1 : 0;
  }
  for (std::size_t i = 0; i < ninths.size(); ++i) {
    if (ninths[i].num_corners == 0 && ninths[i].num_seen > kMinSeen * ninths[i].num_samples) {
      analysis.empty_regions.emplace_back(names[i]);
    }
  }
}

/// Mean and its stdev over the images' means.
RadialBias biasOf(std::size_t band, const std::map<int, std::pair<double, int>>& sums) {
  RadialBias bias;
  bias.from_rad = kBandWidth_rad * static_cast<double>(band);
  bias.to_rad = bias.from_rad + kBandWidth_rad;
  bias.num_images = static_cast<int>(sums.size());
  double squares_px2 = 0.0;
  for (const auto& [view, sum] : sums) {
    bias.mean_px += sum.first / sum.second / bias.num_images;
    squares_px2 += std::pow(sum.first / sum.second, 2) / bias.num_images;
  }
  if (bias.num_images > 1) {
    bias.stdev_px = std::sqrt(std::max(0.0, squares_px2 - bias.mean_px * bias.mean_px) / (bias.num_images - 1));
  }
  return bias;
}

void addRadialBiases(const camera::CameraModel& model, CameraAnalysis& camera) {
  const Eigen::Vector2d centre_px = camera::parameters(model).segment<2>(camera::focalIndex(model) + 2);
  std::map<std::size_t, std::map<int, std::pair<double, int>>> bands;  // band, view: sum and count
  for (const FoundCorner& corner : camera.corners.found) {
    if (corner.used && corner.residual_px && corner.polar_rad && corner.px != centre_px) {
      auto& sum = bands[static_cast<std::size_t>(*corner.polar_rad / kBandWidth_rad)][corner.view];
      sum.first += corner.residual_px->dot((corner.px - centre_px).normalized());
      ++sum.second;
    }
  }
  for (const auto& [band, sums] : bands) {
    camera.radial_biases.push_back(biasOf(band, sums));
  }
}

}  // namespace

Analysis analyse(const pipeline::CalibrationResult& result, const pipeline::CalibrateOptions& options,
                 std::vector<SeenCorners> corners, const std::vector<CameraPictures>& pictures, const Listener& listener) {
  Analysis analysis;
  analysis.timings = cameraTimings(result, corners);
  const auto halves = solveHalves(result, options, listener);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const camera::Camera& camera = result.solution.rig.cameras[i].camera;
    const double max_polar_rad = result.cameras[i].statistics.max_polar_angle_rad;
    CameraAnalysis of_camera;
    of_camera.corners = std::move(corners[i]);
    of_camera.map = emptyMap(camera, SeenPixels(camera, pictures.empty() ? nullptr : &pictures[i]));
    addUncertainty(result.solution, static_cast<int>(i), of_camera);
    if (halves) {
      addDifference(*halves, static_cast<int>(i), of_camera);
    }
    addMedians(max_polar_rad, of_camera);
    addReach(max_polar_rad, of_camera);
    addEmptyRegions(camera, of_camera);
    addRadialBiases(camera.model, of_camera);
    analysis.cameras.push_back(std::move(of_camera));
  }
  return analysis;
}

}  // namespace tartan_calib::report
