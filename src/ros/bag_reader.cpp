#include "tartan_calib/ros/bag_reader.h"

#include <rosbag/view.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "bag_index.h"
#include "head_reader.h"
#include "shared_bag.h"
#include "tartan_calib/error.h"
#include "tartan_calib/io/gray_image.h"
#include "tartan_calib/ros/image_message.h"

namespace tartan_calib::ros {
namespace {

/// Where the images of one topic are.
struct TopicIndex {
  std::string topic;
  bool is_compressed = false;
  std::vector<rosbag::MessageInstance> messages;                    ///< as stored
  std::vector<std::pair<std::int64_t, std::size_t>> stamp_message;  ///< stamp [ns] and index into messages, sorted
  std::size_t num_unreadable = 0;
  std::size_t num_unstamped = 0;
  std::string unreadable_reason;  ///< of the first one
};

std::string imageTopics(const std::map<std::string, std::string>& types) {
  std::string topics;
  for (const auto& [topic, type] : types) {
    if (isImageType(type)) {
      topics += (topics.empty() ? "" : ", ") + topic;
    }
  }
  return topics.empty() ? "none" : topics;
}

TopicIndex emptyIndex(const SharedBag& shared, const std::map<std::string, std::string>& types, const std::string& topic) {
  const auto found = types.find(topic);
  if (found == types.end()) {
    throw InputError("bag " + shared.path + " has no topic " + topic + "; its image topics: " + imageTopics(types));
  }
  if (found->second.find(kTypeSeparator) != std::string::npos) {
    throw InputError("topic " + topic + " of bag " + shared.path + " has messages of several types (" + found->second +
                     "): keep those of one, e.g. with 'rosbag filter'");
  }
  if (!isImageType(found->second)) {
    throw InputError("topic " + topic + " of bag " + shared.path + " has type " + found->second + ", not " + kImageType +
                     " or " + kCompressedType + "; its image topics: " + imageTopics(types));
  }
  TopicIndex index;
  index.topic = topic;
  index.is_compressed = found->second == kCompressedType;
  return index;
}

void checkEncoding(const TopicIndex& index, const MessageHead& head) {
  const std::string& encoding = head.encoding;
  if (!hasReadableEncoding(head)) {
    throw InputError("topic " + index.topic + " has messages that are not of the type that the bag says, " +
                     (index.is_compressed ? kCompressedType : kImageType) + ": record each type on a topic of its own");
  }
  const bool is_supported = index.is_compressed ? isSupportedFormat(encoding) : isSupportedEncoding(encoding);
  if (!is_supported) {
    throw InputError("topic " + index.topic + " has images of encoding '" + encoding +
                     "', which is not supported; convert them to one of " +
                     (index.is_compressed ? supportedFormats() : supportedEncodings()));
  }
}

/// Adds one message to the index of its topic.
void addMessage(const rosbag::MessageInstance& message, HeadReader& heads, TopicIndex& index) {
  MessageHead head;
  try {
    head = heads.read(message, index.is_compressed);
  } catch (const std::exception& error) {
    index.unreadable_reason = index.num_unreadable++ == 0 ? error.what() : index.unreadable_reason;
    return;
  }
  checkEncoding(index, head);
  index.num_unstamped += static_cast<std::size_t>(head.stamp.isZero());
  const ::ros::Time stamp = head.stamp.isZero() ? message.getTime() : head.stamp;
  index.stamp_message.emplace_back(static_cast<std::int64_t>(stamp.toNSec()), index.messages.size());
  index.messages.push_back(message);
}

/// Empty where the file has a structure that only rosbag knows.
std::optional<BagIndex> indexOf(const std::string& path) {
  try {
    return BagIndex(path);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// One pass over the bag, in its own order, for all topics.
void scan(const SharedBag& shared, std::map<std::string, TopicIndex>& indices) {
  std::vector<std::string> topics;
  topics.reserve(indices.size());
  for (const auto& [topic, index] : indices) {
    topics.push_back(topic);
  }
  std::optional<BagIndex> places = indexOf(shared.path);
  HeadReader heads(places ? &*places : nullptr, {topics.begin(), topics.end()});
  rosbag::View view(shared.bag, rosbag::TopicQuery(topics));
  for (const rosbag::MessageInstance& message : view) {
    addMessage(message, heads, indices.at(message.getTopic()));
  }
  for (auto& [topic, index] : indices) {
    std::sort(index.stamp_message.begin(), index.stamp_message.end());
  }
}

void tell(const TopicIndex& index, const io::RecordingOptions& options) {
  if (index.num_unreadable > 0) {
    io::notify(options, "topic " + index.topic + ": " + std::to_string(index.num_unreadable) +
                            " messages cannot be read and are skipped (first: " + index.unreadable_reason + ")");
  }
  if (index.num_unstamped > 0) {
    io::notify(options, "topic " + index.topic + ": " + std::to_string(index.num_unstamped) +
                            " images have no header stamp; the time at which they were received is used");
  }
}

io::TopicStamps stampsOf(const TopicIndex& index) {
  io::TopicStamps stamps{index.topic, {}};
  stamps.stamps_ns.reserve(index.stamp_message.size());
  for (const auto& [stamp_ns, message] : index.stamp_message) {
    stamps.stamps_ns.push_back(stamp_ns);
  }
  return stamps;
}

/// The index with only those images.
std::shared_ptr<const TopicIndex> only(const TopicIndex& index, const std::vector<std::size_t>& images) {
  auto result = std::make_shared<TopicIndex>(index);
  result->stamp_message.clear();
  for (const std::size_t i : images) {
    result->stamp_message.push_back(index.stamp_message[i]);
  }
  return result;
}

/// Takes the message out of the bag now; decodes it, to grey of 8 or 16 bits, when called.
template <class Message>
std::function<cv::Mat()> readMessage(SharedBag& shared, const rosbag::MessageInstance& instance) {
  boost::shared_ptr<const Message> message;
  std::string reason;
  try {
    const std::lock_guard<std::mutex> lock(shared.mutex);
    message = instance.instantiate<Message>();
  } catch (const std::exception& error) {
    reason = error.what();
  }
  return [message, reason] {
    if (!message) {
      throw InputError("message cannot be read: " + reason);
    }
    return grayImage(*message);
  };
}

std::function<cv::Mat()> readImage(SharedBag& shared, const TopicIndex& index, std::size_t position) {
  const rosbag::MessageInstance& instance = index.messages[index.stamp_message[position].second];
  return index.is_compressed ? readMessage<sensor_msgs::CompressedImage>(shared, instance)
                             : readMessage<sensor_msgs::Image>(shared, instance);
}

pipeline::ImageSource imageSource(std::shared_ptr<SharedBag> shared, std::shared_ptr<const TopicIndex> index) {
  return [shared = std::move(shared), index = std::move(index), next = std::size_t{0}]() mutable {
    std::optional<pipeline::StampedImage> image;
    if (next < index->stamp_message.size()) {
      const std::int64_t stamp_ns = index->stamp_message[next].first;
      image.emplace();
      image->stamp_ns = stamp_ns;
      image->load = [decode = readImage(*shared, *index, next), topic = index->topic, stamp_ns] {
        try {
          return io::toGray8(decode(), io::PixelLayout::kGray);
        } catch (const std::exception& error) {
          throw InputError("topic " + topic + ", image " + std::to_string(stamp_ns) + ": " + error.what());
        }
      };
      ++next;
    }
    return image;
  };
}

/// Says how 16-bit images are treated, from the topic's first readable one.
void tellOfReduction(SharedBag& shared, const TopicIndex& index, const io::RecordingOptions& options) {
  for (std::size_t i = 0; i < index.stamp_message.size(); ++i) {
    try {
      return io::notifyOfReduction(options, index.topic, readImage(shared, index, i)());
    } catch (const std::exception&) {
      // Counted where the image is asked for.
    }
  }
}

}  // namespace

std::vector<pipeline::CameraStream> openBag(const std::string& path, const std::vector<std::string>& topics,
                                            const io::RecordingOptions& options) {
  io::checkOptions(options);
  const std::shared_ptr<SharedBag> shared = openShared(path);
  const std::map<std::string, std::string> types = typesByTopic(shared->bag);
  std::map<std::string, TopicIndex> indices;
  for (const std::string& topic : topics) {
    indices.emplace(topic, emptyIndex(*shared, types, topic));
  }
  scan(*shared, indices);

  std::vector<io::TopicStamps> stamps;
  for (const std::string& topic : topics) {
    tell(indices.at(topic), options);
    stamps.push_back(stampsOf(indices.at(topic)));
  }
  const std::vector<std::vector<std::size_t>> selected = io::selectImages(stamps, options);

  std::vector<pipeline::CameraStream> streams;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const std::shared_ptr<const TopicIndex> index = only(indices.at(topics[i]), selected[i]);
    tellOfReduction(*shared, *index, options);
    streams.push_back({topics[i], index->stamp_message.size(), [shared, index] { return imageSource(shared, index); }});
  }
  return streams;
}

}  // namespace tartan_calib::ros
