#include "simulate/truth.h"

#include <iomanip>
#include <set>

#include "simulate/recording_writer.h"
#include "tartan_calib/io/atomic_file.h"
#include "tartan_calib/io/camchain.h"
#include "tartan_calib/io/corners_csv.h"
#include "tartan_calib/io/poses_csv.h"
#include "tartan_calib/io/target_yaml.h"

namespace tartan_calib::apps {
namespace {

/// Cameras that see the same visible corner at the same time, camera by camera.
std::vector<std::vector<int>> overlaps(const std::vector<pipeline::CameraCorners>& cameras) {
  using Sighting = std::pair<std::int64_t, int>;
  std::vector<std::set<Sighting>> seen;
  for (const pipeline::CameraCorners& camera : cameras) {
    seen.emplace_back();
    for (const observation::CameraView& image : camera.images) {
      for (const observation::Corner& corner : image.corners) {
        if (corner.used) {
          seen.back().emplace(image.stamp_ns, corner.corner_id);
        }
      }
    }
  }
  const auto share = [](const std::set<Sighting>& a, const std::set<Sighting>& b) {
    for (const Sighting& sighting : a) {
      if (b.count(sighting) > 0) {
        return true;
      }
    }
    return false;
  };
  std::vector<std::vector<int>> overlaps(seen.size());
  for (std::size_t a = 0; a < seen.size(); ++a) {
    for (std::size_t b = 0; b < seen.size(); ++b) {
      if (a != b && share(seen[a], seen[b])) {
        overlaps[a].push_back(static_cast<int>(b));
      }
    }
  }
  return overlaps;
}

const char* visibility(const simulation::TrueCorner& corner) {
  if (corner.visible) {
    return "visible";
  }
  return corner.hidden ? "hidden" : "near";
}

calibration::Rig rig(const simulation::Scene& scene) {
  calibration::Rig rig;
  for (const simulation::SceneCamera& camera : scene.cameras) {
    rig.cameras.push_back({camera.camera, camera.T_cam_rig});
  }
  return rig;
}

}  // namespace

Truth::Truth(const simulation::Scene& scene) : scene_(scene) {
  visibility_ << "camera,stamp_ns,corner_id,visibility,neighbour_px,motion_px\n" << std::fixed << std::setprecision(2);
  for (const simulation::SceneCamera& camera : scene.cameras) {
    pipeline::CameraCorners corners;
    corners.topic = imageTopic(cameras_.size());
    corners.width = camera.camera.width;
    corners.height = camera.camera.height;
    cameras_.push_back(corners);
  }
}

void Truth::add(const simulation::RenderedFrame& frame) {
  for (std::size_t camera = 0; camera < frame.views.size(); ++camera) {
    observation::CameraView image;
    image.camera_index = static_cast<int>(camera);
    image.stamp_ns = frame.stamp_ns;
    for (const simulation::TrueCorner& corner : frame.views[camera].corners) {
      image.corners.push_back({corner.corner_id, corner.px, corner.bound_px2, corner.visible});
      visibility_ << camera << ',' << frame.stamp_ns << ',' << corner.corner_id << ',' << visibility(corner) << ','
                  << corner.neighbour_distance_px << ',' << corner.motion_px << '\n';
    }
    cameras_[camera].images.push_back(image);
    ++cameras_[camera].num_images;
  }
}

std::size_t Truth::numCorners() const {
  std::size_t count = 0;
  for (const pipeline::CameraCorners& camera : cameras_) {
    for (const observation::CameraView& image : camera.images) {
      count += image.corners.size();
    }
  }
  return count;
}

std::size_t Truth::numVisibleCorners() const {
  std::size_t count = 0;
  for (const pipeline::CameraCorners& camera : cameras_) {
    for (const observation::CameraView& image : camera.images) {
      for (const observation::Corner& corner : image.corners) {
        count += corner.used ? 1U : 0U;
      }
    }
  }
  return count;
}

void Truth::save(const std::string& base) const {
  pipeline::CalibrationResult result;  // the poses' file is one of a calibration
  io::Camchain chain;
  chain.rig = rig(scene_);
  chain.overlaps = overlaps(cameras_);
  for (const pipeline::CameraCorners& camera : cameras_) {
    chain.topics.push_back(camera.topic);
  }
  for (const simulation::SceneFrame& frame : scene_.frames) {
    result.solution.views.push_back({frame.stamp_ns, {}});
    result.solution.T_rig_target.push_back(frame.T_rig_target);
  }
  io::writeFile(base + "-target.yaml", io::targetText(scene_.target));
  io::writeFile(base + "-truth-camchain.yaml", io::camchainText(chain));
  io::writeFile(base + "-truth-poses.csv", io::posesText(result));
  io::saveCorners(base + "-truth-corners.csv", cameras_);
  io::writeFile(base + "-truth-visibility.csv", visibility_.str());
}

}  // namespace tartan_calib::apps
