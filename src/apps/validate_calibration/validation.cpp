#include "validate_calibration/validation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <regex>

#include "tartan_calib/calibration/synchronize.h"
#include "tartan_calib/error.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

using calibration::ImageErrors;
using observation::CameraView;

void checkCorners(const calibration::Rig& rig, int num_target_corners, const std::vector<pipeline::CameraCorners>& corners) {
  if (corners.size() != rig.cameras.size()) {
    throw InputError("the camchain has " + std::to_string(rig.cameras.size()) + " cameras, the recording " +
                     std::to_string(corners.size()) + ": one topic per camera is needed");
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const camera::Camera& camera = rig.cameras[i].camera;
    if (!corners[i].images.empty() && (corners[i].width != camera.width || corners[i].height != camera.height)) {
      throw InputError(format("%s: images of %s are %dx%d, the camchain is for %dx%d", cameraName(i).c_str(),
                              corners[i].topic.c_str(), corners[i].width, corners[i].height, camera.width, camera.height));
    }
    for (const CameraView& image : corners[i].images) {
      for (const observation::Corner& corner : image.corners) {
        if (corner.corner_id < 0 || corner.corner_id >= num_target_corners) {
          throw InputError(format("%s: corner %d is not on the target, which has %d corners", cameraName(i).c_str(),
                                  corner.corner_id, num_target_corners));
        }
      }
    }
  }
}

std::vector<observation::View> viewsOf(const std::vector<pipeline::CameraCorners>& corners, std::int64_t approx_sync_ns) {
  std::vector<std::vector<CameraView>> images(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    images[i] = corners[i].images;
    for (CameraView& image : images[i]) {
      image.camera_index = static_cast<int>(i);
    }
  }
  return calibration::synchronize(images, approx_sync_ns);
}

}  // namespace

Validation validate(const calibration::Rig& rig, const target::Target& target,
                    const std::vector<pipeline::CameraCorners>& corners, std::int64_t approx_sync_ns,
                    const ProgressCall& progress) {
  const std::vector<Eigen::Vector3d> target_points = target::cornerPoints(target);
  checkCorners(rig, static_cast<int>(target_points.size()), corners);
  Validation validation;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    CameraValidation camera;
    camera.topic = corners[i].topic;
    camera.camera = rig.cameras[i].camera;
    camera.num_images = corners[i].num_images;
    validation.cameras.push_back(std::move(camera));
  }
  std::vector<std::vector<ImageErrors>> alone(rig.cameras.size());
  const std::vector<observation::View> views = viewsOf(corners, approx_sync_ns);
  validation.num_views = views.size();
  progress(0, views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    calibration::ViewErrors errors = calibration::validateView(rig, target_points, views[i]);
    validation.num_unexplained += errors.together.empty() ? 1U : 0U;
    validation.num_joint += errors.together.size() > 1 ? 1U : 0U;
    for (ImageErrors& image : errors.together) {
      validation.cameras[static_cast<std::size_t>(image.camera_index)].images.push_back(std::move(image));
    }
    for (ImageErrors& image : errors.alone) {
      alone[static_cast<std::size_t>(image.camera_index)].push_back(std::move(image));
    }
    progress(i + 1, views.size());
  }
  if (validation.num_unexplained == validation.num_views) {
    throw CalibrationError(views.empty()
                               ? "no image shows the target: check target file, focus and exposure"
                               : "no pose of the board explains any of the " + std::to_string(views.size()) +
                                     " views: is this the camchain of these cameras, and the target the right one?");
  }
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    validation.cameras[i].together = calibration::summarizeErrors(validation.cameras[i].images);
    validation.cameras[i].alone = calibration::summarizeErrors(alone[i]);
  }
  return validation;
}

std::vector<double> residualsBeside(const std::string& camchain_file, std::size_t num_cameras) {
  const std::string camchain = "camchain";
  const std::size_t at = camchain_file.rfind(camchain);
  const std::size_t dot = camchain_file.rfind('.');
  if (at == std::string::npos || dot == std::string::npos || dot < at) {
    return {};
  }
  // X-camchain.yaml and, of older Kalibrs, camchain-X.yaml.
  const std::string path = camchain_file.substr(0, at) + "results-cam" +
                           camchain_file.substr(at + camchain.size(), dot - at - camchain.size()) + ".txt";
  const std::regex pattern(R"(reprojection error: \[([^,]+), ([^\]]+)\] \+- \[([^,]+), ([^\]]+)\])");
  std::vector<double> residuals_px;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::smatch match;
    if (!std::regex_search(line, match, pattern)) {
      continue;
    }
    double sum_px2 = 0.0;  // mean and stdev, per axis
    for (std::size_t i = 1; i < match.size(); ++i) {
      const double value_px = std::strtod(match[i].str().c_str(), nullptr);
      sum_px2 += value_px * value_px;
    }
    residuals_px.push_back(std::sqrt(sum_px2));
  }
  const auto is_usable = [](double px) { return std::isfinite(px) && px > 0.0; };
  const bool fits = residuals_px.size() == num_cameras && std::all_of(residuals_px.begin(), residuals_px.end(), is_usable);
  return fits ? residuals_px : std::vector<double>();
}

std::string errorsCsv(const Validation& validation) {
  constexpr double kDegreesPerRadian = 57.29577951308232;
  std::string text = "camera,stamp_ns,corner_id,u_px,v_px,error_u_px,error_v_px,polar_deg,wrong\n";
  for (const CameraValidation& camera : validation.cameras) {
    for (const ImageErrors& image : camera.images) {
      for (const calibration::CornerError& corner : image.corners) {
        text +=
            format("%d,%lld,%d,%.6f,%.6f,%.6f,%.6f,%.4f,%d\n", image.camera_index, static_cast<long long>(image.stamp_ns),
                   corner.corner_id, corner.px.x(), corner.px.y(), corner.error_px.x(), corner.error_px.y(),
                   corner.polar_rad * kDegreesPerRadian, corner.is_wrong ? 1 : 0);
      }
    }
  }
  return text;
}

}  // namespace tartan_calib::apps
