#include "head_reader.h"

#include <exception>
#include <vector>

namespace tartan_calib::ros {
namespace {

/// Enough for the head of any image: stamp, names of frame and encoding, size.
constexpr std::size_t kHeadBytes = 4096;

template <class Head>
MessageHead parseHead(std::vector<std::uint8_t> bytes) {
  Head head;
  ::ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ::ros::serialization::deserialize(stream, head);
  return head.head;
}

}  // namespace

HeadReader::HeadReader(BagIndex* index, const std::set<std::string>& topics) : index_(index) {
  std::set<Key> ambiguous;
  for (std::size_t i = 0; index != nullptr && i < index->messages().size(); ++i) {
    const BagIndex::Message& message = index->messages()[i];
    const std::string& topic = index->topics().at(message.connection);
    if (topics.count(topic) == 0) {
      continue;
    }
    const Key key(topic, message.received_ns);
    if (message.is_compressed || !message_at_.emplace(key, i).second) {
      ambiguous.insert(key);
    }
  }
  for (const Key& key : ambiguous) {
    message_at_.erase(key);
  }
}

MessageHead HeadReader::read(const rosbag::MessageInstance& message, bool is_compressed_image) {
  const auto found = message_at_.find({message.getTopic(), static_cast<std::int64_t>(message.getTime().toNSec())});
  if (found != message_at_.end()) {
    try {
      const std::vector<std::uint8_t> bytes = index_->beginning(index_->messages()[found->second], kHeadBytes);
      return is_compressed_image ? parseHead<CompressedHead>(bytes) : parseHead<ImageHead>(bytes);
    } catch (const std::exception&) {
      // A head that is longer, or damaged: rosbag says which.
    }
  }
  return is_compressed_image ? message.instantiate<CompressedHead>()->head : message.instantiate<ImageHead>()->head;
}

}  // namespace tartan_calib::ros
