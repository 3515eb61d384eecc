#include "check_options.h"

#include <algorithm>

#include "tartan_calib/text.h"

namespace tartan_calib::pipeline {
namespace {

std::string sizeText(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

}  // namespace

void checkOptions(const CalibrateOptions& options, std::size_t num_cameras) {
  if (num_cameras == 0) {
    throw InputError("there is no camera to calibrate");
  }
  if (options.models.size() != num_cameras) {
    throw InputError("exactly one camera model per camera is needed: " + std::to_string(options.models.size()) +
                     " models for " + std::to_string(num_cameras) + " cameras");
  }
  for (const std::string& model : options.models) {
    camera::modelByName(model);
  }
  if (options.approx_sync_ns < 0) {
    throw InputError("the tolerance for synchronisation must not be negative");
  }
  const calibration::SolveOptions& solve = options.solve;
  if (!options.known_rig && (solve.fix_intrinsics || solve.fix_extrinsics || !solve.fixed_cameras.empty())) {
    throw InputError("fixed parameters need a calibration to start from");
  }
  if (options.known_rig && options.known_rig->cameras.size() != num_cameras) {
    throw InputError("the calibration to start from has " + std::to_string(options.known_rig->cameras.size()) +
                     " cameras, there are " + std::to_string(num_cameras));
  }
  for (const int index : solve.fixed_cameras) {
    if (index < 0 || static_cast<std::size_t>(index) >= num_cameras) {
      throw InputError("there is no " + cameraName(index) + " to fix: the cameras are cam0 to " +
                       cameraName(static_cast<int>(num_cameras) - 1));
    }
  }
}

void checkCorners(const CameraCorners& corners, int camera_index, int num_target_corners) {
  const observation::CameraView* last = nullptr;
  for (const observation::CameraView& image : corners.images) {
    const std::string place = cameraName(camera_index) + ", image " + std::to_string(image.stamp_ns);
    if (last != nullptr && last->stamp_ns >= image.stamp_ns) {
      throw InputError(place + ": the stamps of a camera's images must increase");
    }
    last = &image;
    for (const observation::Corner& corner : image.corners) {
      if (corner.corner_id < 0 || corner.corner_id >= num_target_corners) {
        throw InputError(place + ": the target has no corner " + std::to_string(corner.corner_id) + ", it has " +
                         std::to_string(num_target_corners) + "; do the corners belong to another target?");
      }
    }
  }
}

calibration::CameraSpec cameraSpec(const CalibrateOptions& options, const CameraCorners& corners, int camera_index) {
  const auto at = static_cast<std::size_t>(camera_index);
  calibration::CameraSpec spec;
  spec.model_name = options.models[at];
  spec.width = corners.width;
  spec.height = corners.height;
  spec.focal_hint_px = options.focal_hint_px;
  if (options.known_rig) {
    const camera::Camera& known = options.known_rig->cameras[at].camera;
    if (camera::modelName(known.model) != spec.model_name) {
      throw InputError(cameraName(camera_index) + " is to be " + spec.model_name + ", the calibration to start from has " +
                       camera::modelName(known.model));
    }
    if (known.width != spec.width || known.height != spec.height) {
      throw InputError(cameraName(camera_index) + " has images of " + sizeText(spec.width, spec.height) +
                       ", the calibration to start from is for " + sizeText(known.width, known.height));
    }
    spec.known_model = known.model;
  }
  return spec;
}

}  // namespace tartan_calib::pipeline
