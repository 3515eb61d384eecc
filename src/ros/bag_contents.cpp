#include "tartan_calib/ros/bag_contents.h"

#include <rosbag/view.h>

#include <algorithm>
#include <memory>
#include <set>

#include "bag_index.h"
#include "head_reader.h"
#include "shared_bag.h"
#include "tartan_calib/error.h"
#include "tartan_calib/io/gray_image.h"
#include "tartan_calib/ros/image_message.h"

namespace tartan_calib::ros {
namespace {

ImageRecord recordOf(const MessageHead& head, std::int64_t received_ns) {
  return {received_ns, static_cast<std::int64_t>(head.stamp.toNSec()), static_cast<int>(head.width),
          static_cast<int>(head.height), head.encoding};
}

::ros::Time timeOf(std::int64_t stamp_ns) { return ::ros::Time().fromNSec(static_cast<std::uint64_t>(stamp_ns)); }

template <class Message>
cv::Mat loadMessage(SharedBag& shared, const std::string& topic, std::int64_t received_ns) {
  rosbag::View view(shared.bag, rosbag::TopicQuery(topic), timeOf(received_ns), timeOf(received_ns));
  if (view.size() == 0) {
    throw damagedBag(shared.path, "a message is not where it should be");
  }
  const boost::shared_ptr<const Message> message = view.begin()->instantiate<Message>();
  return io::toGray8(grayImage(*message), io::PixelLayout::kGray);
}

std::function<cv::Mat(std::size_t)> loader(std::shared_ptr<SharedBag> shared, const ImageTopic& topic) {
  std::vector<std::int64_t> received_ns;
  for (const ImageRecord& image : topic.images) {
    received_ns.push_back(image.received_ns);
  }
  const auto load =
      topic.type == kCompressedType ? loadMessage<sensor_msgs::CompressedImage> : loadMessage<sensor_msgs::Image>;
  return [shared = std::move(shared), name = topic.topic, received_ns = std::move(received_ns), load](std::size_t index) {
    try {
      return load(*shared, name, received_ns.at(index));
    } catch (const std::exception& error) {
      throw InputError("topic " + name + ", image " + std::to_string(index) + ": " + error.what());
    }
  };
}

/// The image topics of a bag in the making.
class ImageTopics {
 public:
  explicit ImageTopics(const std::map<std::string, std::string>& types) {
    for (const auto& [topic, type] : types) {
      if (isImageType(type)) {
        topics_[topic].topic = topic;
        topics_[topic].type = type;
      }
    }
  }

  bool has(const std::string& topic) const { return topics_.count(topic) > 0; }

  std::set<std::string> names() const {
    std::set<std::string> names;
    for (const auto& [name, topic] : topics_) {
      names.insert(name);
    }
    return names;
  }

  template <class ReadHead>
  void add(const std::string& topic, std::int64_t received_ns, const ReadHead& read_head) {
    ImageTopic& entry = topics_.at(topic);
    try {
      const MessageHead head = read_head(entry.type == kCompressedType);
      if (hasReadableEncoding(head)) {
        entry.images.push_back(recordOf(head, received_ns));
        return;
      }
    } catch (const std::exception&) {
      // Counted with those of another type.
    }
    ++entry.num_unreadable;
  }

  std::vector<ImageTopic> finish(const std::shared_ptr<SharedBag>& shared) {
    std::vector<ImageTopic> finished;
    for (auto& [name, topic] : topics_) {
      std::stable_sort(topic.images.begin(), topic.images.end(),
                       [](const ImageRecord& a, const ImageRecord& b) { return a.received_ns < b.received_ns; });
      const bool is_compressed = topic.type == kCompressedType;
      topic.is_supported = std::all_of(topic.images.begin(), topic.images.end(), [&](const ImageRecord& image) {
        return is_compressed ? isSupportedFormat(image.encoding) : isSupportedEncoding(image.encoding);
      });
      topic.load = loader(shared, topic);
      finished.push_back(std::move(topic));
    }
    std::stable_sort(finished.begin(), finished.end(),
                     [](const ImageTopic& a, const ImageTopic& b) { return a.topic.size() < b.topic.size(); });
    return finished;
  }

 private:
  std::map<std::string, ImageTopic> topics_;
};

void readHeads(const SharedBag& shared, BagIndex& index, ImageTopics& images) {
  HeadReader heads(&index, images.names());
  rosbag::View view(shared.bag,
                    [&images](const rosbag::ConnectionInfo* connection) { return images.has(connection->topic); });
  for (const rosbag::MessageInstance& message : view) {
    images.add(message.getTopic(), static_cast<std::int64_t>(message.getTime().toNSec()),
               [&](bool is_compressed_image) { return heads.read(message, is_compressed_image); });
  }
}

std::vector<OtherTopic> otherTopics(const BagIndex& index, const std::map<std::string, std::string>& types) {
  std::map<std::string, OtherTopic> topics;
  for (const BagIndex::Message& message : index.messages()) {
    const std::string& name = index.topics().at(message.connection);
    if (isImageType(types.at(name))) {
      continue;
    }
    OtherTopic& topic = topics[name];
    topic.first_ns = topic.num_messages == 0 ? message.received_ns : std::min(topic.first_ns, message.received_ns);
    topic.last_ns = std::max(topic.last_ns, message.received_ns);
    ++topic.num_messages;
  }
  std::vector<OtherTopic> list;
  for (auto& [name, topic] : topics) {
    topic.topic = name;
    topic.type = types.at(name);
    list.push_back(topic);
  }
  return list;
}

}  // namespace

BagContents listBag(const std::string& path) {
  const std::shared_ptr<SharedBag> shared = openShared(path);
  const std::map<std::string, std::string> types = typesByTopic(shared->bag);
  BagIndex index(path);
  ImageTopics images(types);
  readHeads(*shared, index, images);
  return {images.finish(shared), otherTopics(index, types)};
}

}  // namespace tartan_calib::ros
