#include "tartan_calib/report/pictures.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <map>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "listen.h"
#include "tartan_calib/text.h"
#include "tartan_calib/threads.h"

namespace tartan_calib::report {
namespace {

constexpr int kFrameWidth_px = 480;
constexpr int kWorstWidth_px = 800;
constexpr int kFrameQuality = 70;  ///< of JPEG
constexpr int kWorstQuality = 85;
constexpr double kWorstMargin_ratio = 0.08;  ///< around the board, of its width
constexpr int kMinMargin_px = 12;

/// What is wanted of one image.
struct Order {
  int view = 0;
  bool is_frame = false;
  std::optional<cv::Rect> worst;  ///< the board in the image
};

struct Taken {
  std::optional<Picture> frame;
  std::optional<Picture> worst;
};

std::map<int, double> meanSquares(const SeenCorners& corners) {
  std::map<int, std::pair<double, int>> sums;
  for (const FoundCorner& corner : corners.found) {
    if (corner.used && corner.residual_px) {
      sums[corner.view].first += corner.residual_px->squaredNorm();
      ++sums[corner.view].second;
    }
  }
  std::map<int, double> means;
  for (const auto& [view, sum] : sums) {
    means[view] = sum.first / sum.second;
  }
  return means;
}

/// Views of one camera with the largest residuals, worst first.
std::vector<int> worstViews(const SeenCorners& corners, int count) {
  const std::map<int, double> means = meanSquares(corners);
  std::vector<int> views;
  for (const auto& [view, mean] : means) {
    views.push_back(view);
  }
  std::stable_sort(views.begin(), views.end(), [&](int a, int b) { return means.at(a) > means.at(b); });
  views.resize(std::min(views.size(), static_cast<std::size_t>(count)));
  return views;
}

cv::Rect boardArea(const SeenCorners& corners, int view, const cv::Size& image) {
  std::vector<cv::Point2f> points;
  for (const FoundCorner& corner : corners.found) {
    if (corner.view == view) {
      points.emplace_back(static_cast<float>(corner.px.x()), static_cast<float>(corner.px.y()));
    }
  }
  const cv::Rect board = cv::boundingRect(points);
  const int margin_px = std::max(kMinMargin_px, static_cast<int>(kWorstMargin_ratio * board.width));
  const cv::Rect area(board.x - margin_px, board.y - margin_px, board.width + 2 * margin_px, board.height + 2 * margin_px);
  return area & cv::Rect({}, image);
}

using Orders = std::map<std::int64_t, Order>;  ///< by the images' stamps

/// Tells how many of the ordered images of all cameras are done.
class Counter {
 public:
  Counter(const std::vector<Orders>& orders, const Listener& listener) : listener_(listener) {
    for (const Orders& of_camera : orders) {
      total_ += of_camera.size();
    }
  }
  void count() {
    ++done_;
    if (listener_.progress) {
      listener_.progress(done_, total_);
    }
  }

 private:
  const Listener& listener_;
  std::size_t done_ = 0;
  std::size_t total_ = 0;
};

/// Pictures of one camera, taken on several threads.
class Photographer {
 public:
  Photographer(Orders orders, std::string folder, std::string name, Counter& counter)
      : orders_(std::move(orders)), folder_(std::move(folder)), name_(std::move(name)), counter_(counter) {}

  void run(const pipeline::CameraStream& stream, const PictureOptions& options) {
    const pipeline::ImageSource source = stream.open();
    std::vector<std::future<void>> workers;
    for (int i = 0; i < numThreads(options.num_threads); ++i) {
      workers.push_back(std::async(std::launch::async, [&] { work(source, options); }));
    }
    for (std::future<void>& worker : workers) {
      worker.get();
    }
    throwIfCancelled(options.listener);
  }

  std::map<int, Taken> taken;  ///< by view
  cv::Mat brightest;

 private:
  void work(const pipeline::ImageSource& source, const PictureOptions& options) {
    while (!isCancelled(options.listener)) {
      std::optional<pipeline::StampedImage> image;
      std::optional<Order> order;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        image = source();
        const auto found = image ? orders_.find(image->stamp_ns) : orders_.end();
        if (found != orders_.end()) {
          order = found->second;
          orders_.erase(found);  // of images with the same stamp the first was calibrated with
        }
      }
      if (!image) {
        return;
      }
      if (order) {
        take(*image, *order);
        const std::lock_guard<std::mutex> lock(mutex_);
        counter_.count();
      }
    }
  }

  void take(const pipeline::StampedImage& stamped, const Order& order) {
    cv::Mat image;
    try {
      image = stamped.load();
    } catch (const InputError&) {
      return;
    }
    Taken pictures;
    cv::Mat small;
    if (order.is_frame) {
      pictures.frame = save(image, {order.view, "frame", kFrameWidth_px, kFrameQuality}, {{}, image.size()}, small);
    }
    if (order.worst) {
      cv::Mat ignored;
      pictures.worst = save(image, {order.view, "worst", kWorstWidth_px, kWorstQuality}, *order.worst, ignored);
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    taken[order.view] = pictures;
    if (!small.empty()) {
      brightest.empty() ? small.copyTo(brightest) : cv::max(brightest, small, brightest);
    }
  }

  struct Format {
    int view = 0;
    const char* kind = "";
    int max_width_px = 0;
    int quality = 0;
  };

  Picture save(const cv::Mat& image, const Format& format, const cv::Rect& area, cv::Mat& saved) const {
    Picture picture;
    picture.view = format.view;
    picture.file = name_ + "-" + format.kind + "-" + std::to_string(format.view) + ".jpg";
    picture.origin_px = {area.x, area.y};
    picture.scale = std::min(1.0, static_cast<double>(format.max_width_px) / std::max(area.width, area.height));
    cv::resize(image(area), saved, {}, picture.scale, picture.scale, cv::INTER_AREA);
    cv::imwrite(folder_ + "/" + picture.file, saved, {cv::IMWRITE_JPEG_QUALITY, format.quality});
    return picture;
  }

  Orders orders_;
  std::string folder_;
  std::string name_;
  Counter& counter_;
  std::mutex mutex_;
};

/// Orders for one camera.
Orders ordersFor(const pipeline::CalibrationResult& result, int camera_index, const SeenCorners& corners,
                 const std::vector<int>& worst, std::size_t max_frames) {
  Orders all;
  const camera::Camera& camera = result.solution.rig.cameras[static_cast<std::size_t>(camera_index)].camera;
  for (std::size_t view = 0; view < result.solution.views.size(); ++view) {
    for (const observation::CameraView& image : result.solution.views[view].cameras) {
      if (image.camera_index == camera_index) {
        all[image.stamp_ns].view = static_cast<int>(view);
      }
    }
  }
  const std::size_t step = (all.size() + max_frames - 1) / max_frames;
  std::size_t index = 0;
  for (auto& [stamp_ns, order] : all) {
    order.is_frame = index++ % std::max<std::size_t>(1, step) == 0;
    if (std::find(worst.begin(), worst.end(), order.view) != worst.end()) {
      order.is_frame = true;
      order.worst = boardArea(corners, order.view, {camera.width, camera.height});
    }
  }
  return all;
}

}  // namespace

std::vector<CameraPictures> takePictures(const std::vector<pipeline::CameraStream>& streams,
                                         const pipeline::CalibrationResult& result, const std::vector<SeenCorners>& corners,
                                         const std::string& folder, const PictureOptions& options) {
  std::vector<std::vector<int>> worst;
  std::vector<Orders> orders;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const auto max_frames = std::max<std::size_t>(1, static_cast<std::size_t>(options.max_frames) / streams.size());
    worst.push_back(worstViews(corners[i], options.num_worst));
    orders.push_back(ordersFor(result, static_cast<int>(i), corners[i], worst[i], max_frames));
  }
  Counter counter(orders, options.listener);
  std::vector<CameraPictures> cameras(corners.size());
  for (std::size_t i = 0; i < streams.size(); ++i) {
    Photographer photographer(orders[i], folder, cameraName(i), counter);
    photographer.run(streams[i], options);
    for (const auto& [view, taken] : photographer.taken) {
      if (taken.frame) {
        cameras[i].frames.push_back(*taken.frame);
      }
    }
    for (const int view : worst[i]) {
      const auto taken = photographer.taken.find(view);
      if (taken != photographer.taken.end() && taken->second.worst) {
        cameras[i].worst.push_back(*taken->second.worst);
      }
    }
    cameras[i].brightest = photographer.brightest;
  }
  return cameras;
}

}  // namespace tartan_calib::report
