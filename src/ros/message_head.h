#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>

#include <cstdint>
#include <string>

namespace tartan_calib::ros {

/// The first fields of an image message, read from it without touching its pixels.
struct MessageHead {
  ::ros::Time stamp;
  std::string encoding;     ///< `format` of a sensor_msgs/CompressedImage
  std::uint32_t width = 0;  ///< 0 in a sensor_msgs/CompressedImage
  std::uint32_t height = 0;
};

struct ImageHead {
  MessageHead head;
};

struct CompressedHead {
  MessageHead head;
};

/// std_msgs/Header, of which only the stamp is kept.
template <class Stream>
void readHeader(Stream& stream, MessageHead& head) {
  std::uint32_t sequence = 0;
  std::string frame_id;
  stream.next(sequence);
  stream.next(head.stamp);
  stream.next(frame_id);
}

}  // namespace tartan_calib::ros

namespace ros {

namespace serialization {

template <>
struct Serializer<tartan_calib::ros::ImageHead> {
  template <class Stream>
  static void read(Stream& stream, tartan_calib::ros::ImageHead& message) {
    tartan_calib::ros::readHeader(stream, message.head);
    stream.next(message.head.height);
    stream.next(message.head.width);
    stream.next(message.head.encoding);
  }
};

template <>
struct Serializer<tartan_calib::ros::CompressedHead> {
  template <class Stream>
  static void read(Stream& stream, tartan_calib::ros::CompressedHead& message) {
    tartan_calib::ros::readHeader(stream, message.head);
    stream.next(message.head.encoding);
  }
};

}  // namespace serialization

namespace message_traits {

/// "*" stands for any type: rosbag then hands the bytes of every message over.
template <>
struct MD5Sum<tartan_calib::ros::ImageHead> {
  static const char* value() { return "*"; }
};

template <>
struct MD5Sum<tartan_calib::ros::CompressedHead> {
  static const char* value() { return "*"; }
};

}  // namespace message_traits

}  // namespace ros
