#include "check_options.h"

#include <algorithm>

#include "tartan_calib/text.h"

namespace tartan_calib::pipeline {
namespace {

std::string sizeText(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

bool hasSize(const camera::Camera& camera, int width, int height) {
  return camera.width == width && camera.height == height;
}

InputError otherSize(int camera_index, int width, int height, const camera::Camera& known) {
  return InputError(cameraName(camera_index) + " has images of " + sizeText(width, height) +
                    ", the calibration to start from is for " + sizeText(known.width, known.height) +
                    ": calibrate without --init");
}

/// Throws InputError where the options do not fit the calibration to start from, or need one that is not there.
void checkKnownRig(const CalibrateOptions& options, std::size_t num_cameras) {
  const calibration::SolveOptions& solve = options.solve;
  if (!options.known_rig) {
    if (solve.fix_intrinsics || solve.fix_extrinsics || !solve.fixed_cameras.empty()) {
      throw InputError("fixed parameters need a calibration to start from");
    }
    return;
  }
  const std::vector<calibration::RigCamera>& known = options.known_rig->cameras;
  if (known.size() != num_cameras) {
    throw InputError("the calibration to start from has " + std::to_string(known.size()) + " cameras, there are " +
                     std::to_string(num_cameras));
  }
  for (std::size_t i = 0; i < num_cameras; ++i) {
    const std::string model = camera::modelName(known[i].camera.model);
    if (model != options.models[i]) {
      throw InputError(cameraName(i) + " is to be " + options.models[i] + ", the calibration to start from has " + model +
                       ": leave --models out, or calibrate without --init");
    }
  }
}

}  // namespace

void checkOptions(const CalibrateOptions& options, const target::Target& target, std::size_t num_cameras) {
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
  if (options.recovery.filter == detection::CornerFilter::kQuads && !std::holds_alternative<target::AprilGrid>(target)) {
    throw InputError("corners can be filtered by quadrilaterals on an AprilGrid only: leave out --corner-filter quads");
  }
  checkKnownRig(options, num_cameras);
  for (const int index : options.solve.fixed_cameras) {
    if (index < 0 || static_cast<std::size_t>(index) >= num_cameras) {
      throw InputError("there is no " + cameraName(index) + " to fix: the cameras are cam0 to " +
                       cameraName(static_cast<int>(num_cameras) - 1));
    }
  }
}

void checkFirstImages(const std::vector<CameraStream>& streams, const calibration::Rig& known_rig) {
  constexpr int kNumImages = 3;  // a single one may be of another size: those are skipped
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const camera::Camera& known = known_rig.cameras[i].camera;
    const ImageSource next_image = streams[i].open();
    cv::Size seen;
    for (int k = 0; k < kNumImages; ++k) {
      const std::optional<StampedImage> image = next_image();
      if (!image) {
        break;
      }
      try {
        seen = image->load().size();
      } catch (const InputError&) {  // counted by the detection
      }
      if (hasSize(known, seen.width, seen.height)) {
        break;
      }
    }
    if (!seen.empty() && !hasSize(known, seen.width, seen.height)) {
      throw otherSize(static_cast<int>(i), seen.width, seen.height, known);
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
  spec.num_threads = options.num_threads;
  if (options.known_rig) {
    const camera::Camera& known = options.known_rig->cameras[at].camera;
    if (!hasSize(known, spec.width, spec.height)) {
      throw otherSize(camera_index, spec.width, spec.height, known);
    }
    spec.known_model = known.model;
  }
  return spec;
}

}  // namespace tartan_calib::pipeline
