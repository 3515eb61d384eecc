#include "tartan_calib/io/recording.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
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

std::vector<std::size_t> inWindow(const TopicStamps& topic, const RecordingOptions& options) {
  if (topic.stamps_ns.empty()) {
    throw InputError("topic " + topic.topic + " has no readable image");
  }
  const std::int64_t first_ns = topic.stamps_ns.front();
  const double length_s = secondsBetween(first_ns, topic.stamps_ns.back());
  if (options.window && (options.window->from_s < 0.0 || options.window->to_s > length_s)) {
    notify(options, "the time window " + windowText(*options.window) + " exceeds topic " + topic.topic + ", which lasts " +
                        std::to_string(length_s) + " s");
  }
  std::vector<std::size_t> selected;
  for (std::size_t i = 0; i < topic.stamps_ns.size(); ++i) {
    const double time_s = secondsBetween(first_ns, topic.stamps_ns[i]);
    if (!options.window || (time_s >= options.window->from_s && time_s <= options.window->to_s)) {
      selected.push_back(i);
    }
  }
  if (selected.empty()) {
    throw InputError("no image of topic " + topic.topic + " lies in the time window " + windowText(*options.window) +
                     ": the topic lasts " + std::to_string(length_s) + " s");
  }
  return selected;
}

/// Stamps of images of any topic, each at least a period after the one before.
std::vector<std::int64_t> moments(const std::vector<TopicStamps>& topics,
                                  const std::vector<std::vector<std::size_t>>& selected, double period_s) {
  std::vector<std::int64_t> all_ns;
  for (std::size_t topic = 0; topic < topics.size(); ++topic) {
    for (const std::size_t i : selected[topic]) {
      all_ns.push_back(topics[topic].stamps_ns[i]);
    }
  }
  std::sort(all_ns.begin(), all_ns.end());
  std::vector<std::int64_t> result_ns;
  for (const std::int64_t stamp_ns : all_ns) {
    if (result_ns.empty() || secondsBetween(result_ns.back(), stamp_ns) >= period_s) {
      result_ns.push_back(stamp_ns);
    }
  }
  return result_ns;
}

/// Those of `selected` that are nearest to one of the moments and less than a period away from it.
std::vector<std::size_t> nearest(const std::vector<std::int64_t>& moments_ns, const std::vector<std::int64_t>& stamps_ns,
                                 const std::vector<std::size_t>& selected, double period_s) {
  std::vector<std::size_t> result;
  std::size_t next = 0;
  for (const std::int64_t moment_ns : moments_ns) {
    const auto distance_ns = [&](std::size_t position) { return std::abs(stamps_ns[selected[position]] - moment_ns); };
    while (next + 1 < selected.size() && distance_ns(next + 1) < distance_ns(next)) {
      ++next;
    }
    const bool is_new = result.empty() || result.back() != selected[next];
    if (is_new && static_cast<double>(distance_ns(next)) < period_s * kNsPerSecond) {
      result.push_back(selected[next]);
    }
  }
  return result;
}

std::vector<std::vector<std::size_t>> thinned(const std::vector<TopicStamps>& topics,
                                              const std::vector<std::vector<std::size_t>>& selected, double period_s) {
  const std::vector<std::int64_t> moments_ns = moments(topics, selected, period_s);
  std::vector<std::vector<std::size_t>> result;
  result.reserve(topics.size());
  for (std::size_t topic = 0; topic < topics.size(); ++topic) {
    result.push_back(nearest(moments_ns, topics[topic].stamps_ns, selected[topic], period_s));
  }
  return result;
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

std::vector<std::vector<std::size_t>> selectImages(const std::vector<TopicStamps>& topics, const RecordingOptions& options) {
  std::vector<std::vector<std::size_t>> selected;
  selected.reserve(topics.size());
  for (const TopicStamps& topic : topics) {
    selected.push_back(inWindow(topic, options));
  }
  return options.max_rate_hz ? thinned(topics, selected, 1.0 / *options.max_rate_hz) : selected;
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
