#include "tartan_calib/simulation/lens.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <type_traits>

#include "random.h"
#include "tartan_calib/error.h"
#include "tartan_calib/geometry/linear_solve.h"

namespace tartan_calib::simulation {
namespace {

constexpr double kRadPerDegree = M_PI / 180.0;

/// What a data sheet says, in pixels.
struct DataSheet {
  int width;
  int height;
  std::function<double(double)> radius;  ///< of an angle from the axis [rad], in units of the focal length
  double focal_px;
  double max_angle_rad;  ///< of the image circle, or of the image's corners where that is smaller
  bool has_image_circle;
};

/// Fisheyes compress their rim a little; r = theta (1 + k theta^2).
constexpr double kFisheyeCompression = -0.01;
/// A wide lens for machine vision with some barrel distortion; r = tan(theta) (1 + k tan^2(theta)) is too strong beyond 100
/// degrees, so the perspective radius is damped instead.
constexpr double kBarrel = -0.06;

double fisheyeRadius(double angle_rad) { return angle_rad * (1.0 + kFisheyeCompression * angle_rad * angle_rad); }
double barrelRadius(double angle_rad) {
  const double x = std::tan(angle_rad);
  return x * (1.0 + kBarrel * x * x / (1.0 + x * x));
}

DataSheet circularFisheye(int width, int height, double angle_rad, double circle_px) {
  return {width, height, fisheyeRadius, circle_px / fisheyeRadius(angle_rad), angle_rad, true};
}

/// A lens that fills the sensor: its angle at the middle of the left and right border is given.
DataSheet fullFrame(int width, int height, double half_angle_rad, const std::function<double(double)>& radius) {
  const double focal_px = 0.5 * width / radius(half_angle_rad);
  const double corner_px = 0.5 * std::hypot(width, height);
  double corner_angle_rad = half_angle_rad;
  constexpr double kStepRad = 1e-3;
  while (focal_px * radius(corner_angle_rad) < corner_px && radius(corner_angle_rad + kStepRad) > radius(corner_angle_rad)) {
    corner_angle_rad += kStepRad;
  }
  return {width, height, radius, focal_px, corner_angle_rad, false};
}

/// Hero 8 in its 4:3 mode: 122.6 degrees across and 149.2 along the diagonal determine focal length and one coefficient.
DataSheet goPro(int width, int height) {
  constexpr double kGrowth = 0.0525;
  const auto radius = [](double angle_rad) { return angle_rad * (1.0 + kGrowth * angle_rad * angle_rad); };
  return fullFrame(width, height, 61.3 * kRadPerDegree, radius);
}

/// The number in a name like fisheye150; empty where the name is not the prefix and a number.
std::optional<double> numberAfter(const std::string& prefix, const std::string& name) {
  constexpr std::size_t kMaxDigits = 3;
  if (name.compare(0, prefix.size(), prefix) != 0) {
    return std::nullopt;
  }
  const std::string digits = name.substr(prefix.size());
  if (digits.empty() || digits.size() > kMaxDigits || digits.find_first_not_of("0123456789") != std::string::npos) {
    return std::nullopt;
  }
  return std::stod(digits);
}

DataSheet dataSheet(const LensRequest& request) {
  const auto width = [&](int own) { return request.width > 0 ? request.width : own; };
  const auto height = [&](int own) { return request.height > 0 ? request.height : own; };
  if (request.lens == "bf5m195") {
    constexpr double kCircleOfWidth = 560.0 / 1224.0;
    return circularFisheye(width(1224), height(1024), 97.5 * kRadPerDegree, kCircleOfWidth * width(1224));
  }
  if (request.lens == "gopro150") {
    return goPro(width(1280), height(960));
  }
  const std::optional<double> fisheye_degrees = numberAfter("fisheye", request.lens);
  const std::optional<double> pinhole_degrees = numberAfter("pinhole", request.lens);
  if (fisheye_degrees || pinhole_degrees) {
    const bool is_fisheye = fisheye_degrees.has_value();
    const double half_angle_rad = 0.5 * (is_fisheye ? *fisheye_degrees : *pinhole_degrees) * kRadPerDegree;
    const double max_degrees = is_fisheye ? 260.0 : 130.0;
    if (half_angle_rad >= 10.0 * kRadPerDegree && 2.0 * half_angle_rad <= (max_degrees + 1e-9) * kRadPerDegree) {
      constexpr double kMinCircleRad = 85.0 * kRadPerDegree;  // smaller ones are cut by the sensor
      constexpr double kCircleOfWidth = 0.48;
      if (!is_fisheye) {
        return fullFrame(width(752), height(480), half_angle_rad, barrelRadius);
      }
      return half_angle_rad < kMinCircleRad
                 ? fullFrame(width(1000), height(800), half_angle_rad, fisheyeRadius)
                 : circularFisheye(width(1000), height(800), half_angle_rad, kCircleOfWidth * width(1000));
    }
  }
  throw InputError("unknown lens '" + request.lens +
                   "'; choose bf5m195, gopro150, fisheye20 to fisheye260 or pinhole20 to pinhole130");
}

struct Ray {
  Eigen::Vector3d direction;
  Eigen::Vector2d px;
};

std::vector<Ray> sampleRays(const DataSheet& sheet, const Eigen::Vector2d& centre_px) {
  constexpr int kAngles = 48;
  constexpr int kAzimuths = 8;
  std::vector<Ray> rays;
  for (int i = 1; i <= kAngles; ++i) {
    const double angle_rad = sheet.max_angle_rad * i / kAngles;
    for (int j = 0; j < kAzimuths; ++j) {
      const double azimuth_rad = 2.0 * M_PI * j / kAzimuths;
      const Eigen::Vector2d across(std::cos(azimuth_rad), std::sin(azimuth_rad));
      Ray ray;
      ray.direction << std::sin(angle_rad) * across, std::cos(angle_rad);
      ray.px = centre_px + sheet.focal_px * sheet.radius(angle_rad) * across;
      rays.push_back(ray);
    }
  }
  return rays;
}

/// Normal equations of the rays' pixel errors.
struct FitState {
  Eigen::MatrixXd normal;
  Eigen::VectorXd right;
  double squared_px2 = 0.0;
  int num_missing = 0;  ///< rays without an image
};

FitState evaluateFit(const camera::CameraModel& model, const std::vector<Ray>& rays) {
  const int size = camera::numParameters(model);
  FitState state;
  state.normal = Eigen::MatrixXd::Zero(size, size);
  state.right = Eigen::VectorXd::Zero(size);
  camera::ParameterJacobian J(2, size);
  for (const Ray& ray : rays) {
    const auto px = camera::project(model, ray.direction, nullptr, &J);
    if (!px) {
      ++state.num_missing;
      continue;
    }
    const Eigen::Vector2d error = ray.px - *px;
    state.normal += J.transpose().lazyProduct(J);
    state.right += J.transpose().lazyProduct(error);
    state.squared_px2 += error.squaredNorm();
  }
  return state;
}

/// The model whose pixels are nearest to the data sheet's; Levenberg-Marquardt.
camera::CameraModel fitModel(const camera::CameraModel& start, const std::vector<Ray>& rays) {
  constexpr int kMaxSteps = 200;
  camera::CameraModel model = start;
  FitState state = evaluateFit(model, rays);
  double damping = 1e-3;
  for (int step = 0; step < kMaxSteps; ++step) {
    Eigen::MatrixXd damped = state.normal;
    damped.diagonal() += damping * state.normal.diagonal() + Eigen::VectorXd::Constant(damped.rows(), 1e-12);
    const Eigen::VectorXd moved = camera::parameters(model) + geometry::solveSymmetric(damped, state.right);
    const Eigen::VectorXd inside = moved.cwiseMax(camera::lowerBound(model)).cwiseMin(camera::upperBound(model));
    const camera::CameraModel candidate = camera::withParameters(model, inside);
    const FitState candidate_state = evaluateFit(candidate, rays);
    const bool is_better =
        candidate_state.num_missing < state.num_missing ||
        (candidate_state.num_missing == state.num_missing && candidate_state.squared_px2 < state.squared_px2);
    if (is_better) {
      model = candidate;
      state = candidate_state;
    }
    damping *= is_better ? 0.2 : 5.0;
  }
  return model;
}

}  // namespace

SceneCamera makeLens(const LensRequest& request) {
  const DataSheet sheet = dataSheet(request);
  const Eigen::Vector2d centre_px(0.5 * (sheet.width - 1), 0.5 * (sheet.height - 1));
  const std::vector<Ray> rays = sampleRays(sheet, centre_px);
  const camera::CameraModel start = camera::startModel(camera::modelByName(request.model), sheet.focal_px, centre_px);
  SceneCamera lens;
  lens.camera = {fitModel(start, rays), sheet.width, sheet.height};
  const FitState fit = evaluateFit(lens.camera.model, rays);
  constexpr double kMaxErrorOfRadius = 0.01;
  const double radius_px = sheet.focal_px * sheet.radius(sheet.max_angle_rad);
  const double rms_px = std::sqrt(fit.squared_px2 / static_cast<double>(rays.size()));
  if (fit.num_missing > 0 || !(rms_px < kMaxErrorOfRadius * radius_px)) {
    throw InputError(request.model + " cannot show the lens " + request.lens + " out to " +
                     std::to_string(std::lround(sheet.max_angle_rad / kRadPerDegree)) +
                     " degrees from its axis; choose another model, such as ds-none or pinhole-equi, or a narrower lens");
  }
  if (sheet.has_image_circle) {
    lens.image_circle_px = radius_px;
    lens.vignetting = 0.75;
  }
  return lens;
}

SceneCamera anotherPiece(const SceneCamera& lens, std::uint64_t seed) {
  constexpr double kFocalSpread = 0.003;
  constexpr double kAspectSpread = 0.0005;
  constexpr double kCentreSpreadOfWidth = 0.004;
  Random random(seed);
  SceneCamera piece = lens;
  const int focal_index = camera::focalIndex(lens.camera.model);
  const double scale = 1.0 + kFocalSpread * random.normal();
  Eigen::VectorXd parameters = camera::parameters(lens.camera.model);
  parameters(focal_index) *= scale;
  parameters(focal_index + 1) *= scale * (1.0 + kAspectSpread * random.normal());
  parameters(focal_index + 2) += kCentreSpreadOfWidth * lens.camera.width * random.normal();
  parameters(focal_index + 3) += kCentreSpreadOfWidth * lens.camera.width * random.normal();
  piece.camera.model = camera::withParameters(lens.camera.model, parameters);
  piece.image_circle_px *= scale;
  return piece;
}

}  // namespace tartan_calib::simulation
