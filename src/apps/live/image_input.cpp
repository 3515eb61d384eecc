#include "live/image_input.h"

#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <boost/make_shared.hpp>
#include <utility>

#include "tartan_calib/error.h"
#include "tartan_calib/io/gray_image.h"
#include "tartan_calib/ros/image_message.h"

namespace tartan_calib::apps {
namespace {

constexpr const char* kCompressedSuffix = "/compressed";

/// Messages that roscpp keeps before the callback has them; the callback is quick.
constexpr std::uint32_t kQueueSize = 4;

/// How often images that wait for others are looked at again.
constexpr std::chrono::milliseconds kRecheck{10};

bool isCompressed(const std::string& topic) {
  const std::string suffix = kCompressedSuffix;
  return topic.size() > suffix.size() && topic.compare(topic.size() - suffix.size(), suffix.size(), suffix) == 0;
}

}  // namespace

ImageInput::ImageInput(::ros::NodeHandle node, const std::vector<std::string>& topics,
                       const guidance::NewestViewOptions& options)
    : waiting_(topics.size(), options), num_received_(topics.size(), 0) {
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (isCompressed(topics[i])) {
      subscribe<sensor_msgs::CompressedImage>(node, topics[i], static_cast<int>(i));
    } else {
      subscribe<sensor_msgs::Image>(node, topics[i], static_cast<int>(i));
    }
  }
}

template <class Message>
void ImageInput::subscribe(::ros::NodeHandle& node, const std::string& topic, int camera_index) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
      [this, camera_index](const boost::shared_ptr<const Message>& message) {
        const ::ros::Time stamp = message->header.stamp.isZero() ? ::ros::Time::now() : message->header.stamp;
        add(camera_index, static_cast<std::int64_t>(stamp.toNSec()),
            [message] { return io::toGray8(ros::grayImage(*message), io::PixelLayout::kGray); });
      };
  subscribers_.push_back(
      node.subscribe<Message>(topic, kQueueSize, callback, ::ros::VoidConstPtr(), ::ros::TransportHints().tcpNoDelay()));
}

void ImageInput::add(int camera_index, std::int64_t stamp_ns, Decode decode) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++num_received_[static_cast<std::size_t>(camera_index)];
    waiting_.add({camera_index, stamp_ns, std::move(decode)}, std::chrono::steady_clock::now());
  }
  arrived_.notify_one();
}

std::vector<ArrivedImage> ImageInput::take(std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  std::unique_lock<std::mutex> lock(mutex_);
  std::vector<ArrivedImage> images;
  while (images.empty() && std::chrono::steady_clock::now() < deadline) {
    for (auto& entry : waiting_.take(std::chrono::steady_clock::now())) {
      images.push_back({entry.camera_index, entry.stamp_ns, std::move(entry.image)});
    }
    if (images.empty()) {
      arrived_.wait_for(lock, kRecheck);
    }
  }
  return images;
}

InputCounts ImageInput::counts(int camera_index) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {num_received_[static_cast<std::size_t>(camera_index)], waiting_.numDropped(camera_index)};
}

}  // namespace tartan_calib::apps
