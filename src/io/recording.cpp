#include "tartan_calib/io/recording.h"

#include <cmath>
#include <sstream>

#include "tartan_calib/error.h"
#include "tartan_calib/io/gray_image.h"

namespace tartan_calib::io {
namespace {

constexpr double kNsPerSecond = 1e9;

double secondsBetween(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) / kNsPerSecond;
}

std::string windowText(const TimeWindow& window) {
  std::ostringstream text;
  text << window.from_s << " to " << window.to_s << " s";
  return text.str();
}

}  // namespace

void checkOptions(const RecordingOptions& options) {
  if (options.window && !(options.window->from_s < options.window->to_s)) {
    throw InputError("the time window " + windowText(*options.window) + " is empty: its start must be smaller than its end");
  }
  if (options.max_rate_hz && !(*options.max_rate_hz > 0.0 && std::isfinite(*options.max_rate_hz))) {
    throw InputError("the image rate must be a positive number of images per second, not " +
                     std::to_string(*options.max_rate_hz));
  }
}

std::vector<std::size_t> selectImages(const std::vector<std::int64_t>& stamps_ns, const std::string& topic,
                                      const RecordingOptions& options) {
  if (stamps_ns.empty()) {
    throw InputError("topic " + topic + " has no readable image");
  }
  const std::int64_t first_ns = stamps_ns.front();
  const double length_s = secondsBetween(first_ns, stamps_ns.back());
  if (options.window && (options.window->from_s < 0.0 || options.window->to_s > length_s)) {
    notify(options, "the time window " + windowText(*options.window) + " exceeds topic " + topic + ", which lasts " +
                        std::to_string(length_s) + " s");
  }
  const double period_s = options.max_rate_hz ? 1.0 / *options.max_rate_hz : 0.0;
  std::vector<std::size_t> selected;
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) {
    const double time_s = secondsBetween(first_ns, stamps_ns[i]);
    const bool in_window = !options.window || (time_s >= options.window->from_s && time_s <= options.window->to_s);
    const bool is_due = selected.empty() || secondsBetween(stamps_ns[selected.back()], stamps_ns[i]) >= period_s;
    if (in_window && is_due) {
      selected.push_back(i);
    }
  }
  if (selected.empty()) {
    throw InputError("no image of topic " + topic + " lies in the time window " + windowText(*options.window) +
                     ": the topic lasts " + std::to_string(length_s) + " s");
  }
  return selected;
}

void notify(const RecordingOptions& options, const std::string& message) {
  if (options.notice) {
    options.notice(message);
  }
}

void notifyOfReduction(const RecordingOptions& options, const std::string& topic, const cv::Mat& gray) {
  if (gray.depth() != CV_16U) {
    return;
  }
  notify(options, "topic " + topic + " has 16-bit images: " +
                      (spansFewLevels(gray) ? "each is scaled to 8 bits by its own range, as they use few of the 16 bits"
                                            : "their upper byte is used"));
}

}  // namespace tartan_calib::io
