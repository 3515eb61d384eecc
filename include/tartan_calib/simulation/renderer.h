#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/simulation/scene.h"
#include "tartan_calib/simulation/true_corner.h"

namespace tartan_calib::simulation {

/// Corners must be so far from an occluder to count as visible.
constexpr double kMinOccluderDistancePx = 6.0;

struct RenderedView {
  cv::Mat image;                    ///< CV_8UC1
  std::vector<TrueCorner> corners;  ///< in the middle of the exposure, by increasing id
  geometry::Rigid3 T_cam_target;    ///< in the middle of the exposure
};

struct RenderedFrame {
  std::int64_t stamp_ns = 0;
  std::vector<RenderedView> views;  ///< one for each camera
};

/// Turns a scene into pictures: exact pixel areas of board and hand over a room, summed over the motion during the exposure,
/// lens shading, point spread, noise, rounding. The same bytes for the same scene, in any order and from any thread.
class Renderer {
 public:
  /// Throws InputError for a target or camera that cannot be rendered.
  explicit Renderer(Scene scene);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  const Scene& scene() const;

  /// May be called from several threads. Once `is_stopped`, frames lack views.
  RenderedFrame render(int frame_index, const std::atomic<bool>& is_stopped = false) const;

  /// The light of one camera's picture before noise and rounding, in grey levels.
  cv::Mat1f renderLight(int frame_index, int camera_index) const;

 private:
  class Studio;
  std::unique_ptr<const Studio> studio_;
};

/// Renders all frames with `num_threads` and hands them over in order, on the calling thread. `waiting`, where there is one,
/// is called before each and several times a second. Where one of the two throws, no further view is begun.
void renderAll(const Renderer& renderer, int num_threads, const std::function<void(const RenderedFrame&)>& receive,
               const std::function<void()>& waiting = {});

}  // namespace tartan_calib::simulation
