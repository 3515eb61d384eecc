#include "tartan_calib/simulation/renderer.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>
#include <future>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "exposure.h"
#include "information_bound.h"
#include "lens_shading.h"
#include "room.h"
#include "tartan_calib/simulation/board_pattern.h"
#include "tartan_calib/simulation/sensor.h"

namespace tartan_calib::simulation {
namespace {

/// A seed of its own for every picture, far from its neighbours' (Steele et al. 2014, SplitMix64).
std::uint64_t pictureSeed(std::uint64_t seed, std::size_t frame_index, std::size_t camera_index) {
  std::uint64_t z = seed + 0x9e3779b97f4a7c15U * (1U + frame_index) + 0xd1b54a32d192ed03U * (1U + camera_index);
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

bool isCovered(const cv::Mat1f& cover, const Eigen::Vector2d& px) {
  constexpr float kHalfCovered = 0.5F;  // where an edge runs through the middle of a pixel
  cv::Mat1f at_corner;
  cv::getRectSubPix(cover, {1, 1}, {static_cast<float>(px.x()), static_cast<float>(px.y())}, at_corner);
  return at_corner(0, 0) >= kHalfCovered;
}

void hideBehindOccluder(std::vector<TrueCorner>& corners, const Exposure& exposure) {
  if (exposure.occluded.empty()) {
    return;
  }
  const cv::Mat clear = exposure.occluded == 0;
  cv::Mat1f distance_px;
  cv::distanceTransform(clear, distance_px, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  constexpr double kHalfPixel = 0.5;  // distances go from centre to centre
  for (TrueCorner& corner : corners) {
    const int col = std::clamp(static_cast<int>(std::lround(corner.px.x())), 0, distance_px.cols - 1);
    const int row = std::clamp(static_cast<int>(std::lround(corner.px.y())), 0, distance_px.rows - 1);
    corner.visible &= static_cast<double>(distance_px(row, col)) >= kMinOccluderDistancePx + kHalfPixel;
    corner.hidden |= isCovered(exposure.cover, corner.px);
  }
}

void measureMotion(std::vector<TrueCorner>& corners, const Scene& scene, const SceneCamera& camera,
                   const SceneFrame& frame) {
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(scene.target);
  const auto place = [&](const TrueCorner& corner, double s) {
    const geometry::Rigid3 T_cam_target = boardPose(camera, frame) * geometry::expRigid(s * frame.motion);
    return camera::project(camera.camera.model, T_cam_target * points[static_cast<std::size_t>(corner.corner_id)]);
  };
  for (TrueCorner& corner : corners) {
    const auto start_px = place(corner, -0.5);
    const auto end_px = place(corner, 0.5);
    corner.motion_px = start_px && end_px ? (*end_px - *start_px).norm() : std::numeric_limits<double>::infinity();
  }
}

struct StopAtEnd {
  std::atomic<bool>& is_stopped;
  ~StopAtEnd() { is_stopped = true; }
};

}  // namespace

class Renderer::Studio {
 public:
  explicit Studio(Scene scene)
      : scene_(std::move(scene)), pattern_(boardPattern(scene_.target, scene_.board_margin_m)), room_(scene_.seed) {
    for (const SceneCamera& camera : scene_.cameras) {
      exposure_makers_.emplace_back(scene_, camera);
    }
  }

  const Scene& scene() const { return scene_; }

  Exposure expose(std::size_t frame_index, std::size_t camera_index) const {
    return exposure_makers_.at(camera_index).expose(scene_, pattern_, room_, scene_.frames.at(frame_index));
  }

  RenderedView view(std::size_t frame_index, std::size_t camera_index) const {
    const SceneCamera& camera = scene_.cameras[camera_index];
    const Exposure exposure = expose(frame_index, camera_index);
    RenderedView view;
    view.T_cam_target = boardPose(camera, scene_.frames[frame_index]);
    view.image = simulation::expose(exposure.light, scene_.sensor, pictureSeed(scene_.seed, frame_index, camera_index));
    view.corners = projectCorners(scene_.target, camera.camera, view.T_cam_target);
    for (TrueCorner& corner : view.corners) {
      const double inside_px = distanceInsideCircle(camera, corner.px);
      corner.visible &= inside_px >= kMinBorderDistancePx;
      corner.hidden |= inside_px < 0.0;
    }
    hideBehindOccluder(view.corners, exposure);
    measureMotion(view.corners, scene_, camera, scene_.frames[frame_index]);
    const InformationBound bound(exposure, scene_, camera.camera, view.T_cam_target);
    for (TrueCorner& corner : view.corners) {
      corner.bound_px2 = bound.ofCorner(corner);
    }
    return view;
  }

 private:
  Scene scene_;
  BoardPattern pattern_;
  Room room_;
  std::vector<ExposureMaker> exposure_makers_;
};

Renderer::Renderer(Scene scene) : studio_(std::make_unique<const Studio>(std::move(scene))) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const Scene& Renderer::scene() const { return studio_->scene(); }

RenderedFrame Renderer::render(int frame_index, const std::atomic<bool>& is_stopped) const {
  const auto index = static_cast<std::size_t>(frame_index);
  RenderedFrame frame;
  frame.stamp_ns = scene().frames.at(index).stamp_ns;
  for (std::size_t camera = 0; camera < scene().cameras.size() && !is_stopped; ++camera) {
    frame.views.push_back(studio_->view(index, camera));
  }
  return frame;
}

cv::Mat1f Renderer::renderLight(int frame_index, int camera_index) const {
  return studio_->expose(static_cast<std::size_t>(frame_index), static_cast<std::size_t>(camera_index)).light;
}

void renderAll(const Renderer& renderer, int num_threads, const std::function<void(const RenderedFrame&)>& receive,
               const std::function<void()>& waiting) {
  constexpr std::chrono::milliseconds kPoll{50};
  const int num_frames = static_cast<int>(renderer.scene().frames.size());
  std::atomic<bool> is_stopped = false;
  std::deque<std::future<RenderedFrame>> pending;
  const StopAtEnd stops_before_pending_is_awaited{is_stopped};
  for (int next = 0; next < num_frames || !pending.empty();) {
    while (next < num_frames && static_cast<int>(pending.size()) < std::max(1, num_threads)) {
      pending.push_back(std::async(std::launch::async, [&, next] { return renderer.render(next, is_stopped); }));
      ++next;
    }
    do {
      if (waiting) {
        waiting();
      }
    } while (pending.front().wait_for(kPoll) != std::future_status::ready);
    const RenderedFrame frame = pending.front().get();
    pending.pop_front();
    receive(frame);
  }
}

}  // namespace tartan_calib::simulation
