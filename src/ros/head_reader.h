#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "bag_index.h"
#include "message_head.h"
#include "shared_bag.h"

namespace tartan_calib::ros {

/// Reads the first fields of image messages from where the file has them. rosbag would fetch whole chunks, that is, every
/// pixel of the recording; only what it unpacks, and what the index does not tell apart, is read through it.
class HeadReader {
 public:
  /// Of messages on these topics. Keeps the pointer; without an index rosbag reads all heads.
  HeadReader(BagIndex* index, const std::set<std::string>& topics);

  /// Throws where the message is damaged.
  MessageHead read(const rosbag::MessageInstance& message, bool is_compressed_image);

 private:
  using Key = std::pair<std::string, std::int64_t>;  ///< topic and time of reception [ns]

  BagIndex* index_;
  std::map<Key, std::size_t> message_at_;
};

}  // namespace tartan_calib::ros
