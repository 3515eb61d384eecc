#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace tartan_calib::guidance {

struct NewestViewOptions {
  std::int64_t sync_ns = 20'000'000;             ///< largest distance of two stamps in a view
  double max_rate_hz = 0.0;                      ///< of views taken; 0: no limit
  std::chrono::milliseconds patience{100};       ///< how long images wait for those of the other cameras
  std::chrono::milliseconds silence{1000};       ///< a camera that sent nothing for so long is not waited for
  static constexpr std::size_t kMaxWaiting = 8;  ///< images kept per camera
};

/// Lets a slow consumer have the newest images of several cameras that belong together. Whatever is older than what it was
/// given is dropped and counted, so it never lags behind and memory is bounded. Not thread-safe; knows no clock.
template <class Image>
class NewestView {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Entry {
    int camera_index = 0;
    std::int64_t stamp_ns = 0;
    Image image;
  };

  NewestView(std::size_t num_cameras, const NewestViewOptions& options) : cameras_(num_cameras), options_(options) {}

  /// `now` never decreases.
  void add(Entry entry, Time now) {
    Camera& camera = cameras_[static_cast<std::size_t>(entry.camera_index)];
    if (!camera.waiting.empty() && entry.stamp_ns <= camera.waiting.back().entry.stamp_ns) {  // its clock was set back
      drop(camera, camera.waiting.size());
    }
    camera.last_arrival = now;
    camera.waiting.push_back({std::move(entry), now});
    drop(camera, camera.waiting.size() > NewestViewOptions::kMaxWaiting ? 1 : 0);
  }

  /// The newest images that belong together, by camera: of all cameras that send any, or of some once one of them has waited
  /// too long. Empty where there is nothing new, or the largest rate says wait.
  std::vector<Entry> take(Time now) {
    const bool is_due = !last_taken_ || options_.max_rate_hz <= 0.0 ||
                        std::chrono::duration<double>(now - *last_taken_).count() * options_.max_rate_hz >= 1.0;
    const std::optional<std::int64_t> stamp_ns = is_due ? newestStamp(now) : std::nullopt;
    std::vector<Entry> view;
    if (!stamp_ns) {
      return view;
    }
    last_taken_ = now;
    for (Camera& camera : cameras_) {
      const auto chosen = nearest(camera, *stamp_ns);
      if (chosen != camera.waiting.end()) {
        view.push_back(std::move(chosen->entry));
        const auto num_older = static_cast<std::size_t>(chosen - camera.waiting.begin());
        drop(camera, num_older);
        camera.waiting.pop_front();
      }
    }
    return view;
  }

  std::size_t numDropped(int camera_index) const { return cameras_[static_cast<std::size_t>(camera_index)].num_dropped; }

 private:
  struct Waiting {
    Entry entry;
    Time arrival;
  };

  struct Camera {
    std::deque<Waiting> waiting;  ///< by increasing stamp
    std::optional<Time> last_arrival;
    std::size_t num_dropped = 0;
  };

  static void drop(Camera& camera, std::size_t count) {
    camera.waiting.erase(camera.waiting.begin(), camera.waiting.begin() + static_cast<std::ptrdiff_t>(count));
    camera.num_dropped += count;
  }

  auto nearest(Camera& camera, std::int64_t stamp_ns) const {
    const auto distance = [&](const Waiting& waiting) { return std::abs(waiting.entry.stamp_ns - stamp_ns); };
    const auto closest = std::min_element(camera.waiting.begin(), camera.waiting.end(),
                                          [&](const Waiting& a, const Waiting& b) { return distance(a) < distance(b); });
    return closest != camera.waiting.end() && distance(*closest) <= options_.sync_ns ? closest : camera.waiting.end();
  }

  bool isSending(const Camera& camera, Time now) const {
    return camera.last_arrival && now - *camera.last_arrival <= options_.silence;
  }

  bool isComplete(std::int64_t stamp_ns, Time now) {
    return std::all_of(cameras_.begin(), cameras_.end(), [&](Camera& camera) {
      return !isSending(camera, now) || nearest(camera, stamp_ns) != camera.waiting.end();
    });
  }

  /// Of the view to take: the newest complete one, else the newest one with an image that waited too long.
  std::optional<std::int64_t> newestStamp(Time now) {
    std::optional<std::int64_t> complete_ns;
    std::optional<std::int64_t> newest_ns;
    bool is_overdue = false;
    for (const Camera& camera : cameras_) {
      for (const Waiting& waiting : camera.waiting) {
        const std::int64_t stamp_ns = waiting.entry.stamp_ns;
        newest_ns = std::max(newest_ns.value_or(stamp_ns), stamp_ns);
        is_overdue = is_overdue || now - waiting.arrival >= options_.patience;
        if (stamp_ns > complete_ns.value_or(stamp_ns - 1) && isComplete(stamp_ns, now)) {
          complete_ns = stamp_ns;
        }
      }
    }
    return complete_ns ? complete_ns : is_overdue ? newest_ns : std::nullopt;
  }

  std::vector<Camera> cameras_;
  NewestViewOptions options_;
  std::optional<Time> last_taken_;
};

}  // namespace tartan_calib::guidance
