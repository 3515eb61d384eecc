#pragma once

#include <rosbag/bag.h>
#include <rosbag/message_instance.h>

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "message_head.h"
#include "tartan_calib/error.h"

namespace tartan_calib::ros {

constexpr const char* kImageType = "sensor_msgs/Image";
constexpr const char* kCompressedType = "sensor_msgs/CompressedImage";
constexpr const char* kTypeSeparator = " and ";  ///< no type has a blank in its name

/// A bag that several streams read from; rosbag itself may be used by one thread at a time.
struct SharedBag {
  std::string path;
  rosbag::Bag bag;
  std::mutex mutex;
};

/// For a bag whose content is not what its index says.
InputError damagedBag(const std::string& path, const std::string& reason);

/// Throws InputError that says what is wrong with the file, and what to do.
std::shared_ptr<SharedBag> openShared(const std::string& path);

/// Types that share a topic are joined by kTypeSeparator.
std::map<std::string, std::string> typesByTopic(const rosbag::Bag& bag);

bool isImageType(const std::string& type);

/// False for the bytes of another type of message, which its place on a topic makes an image.
bool hasReadableEncoding(const MessageHead& head);

}  // namespace tartan_calib::ros
