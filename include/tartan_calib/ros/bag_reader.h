#pragma once

#include <string>
#include <vector>

#include "tartan_calib/io/recording.h"
#include "tartan_calib/pipeline/camera_stream.h"

namespace tartan_calib::ros {

/// Opens image topics of a ROS 1 bag; one stream per topic, images by increasing header stamp (receive time where the stamp
/// was never set). sensor_msgs/Image in mono8, mono16, bgr8, rgb8, bgra8, rgba8, 8UC1/3/4, 16UC1, bayer_*8, yuv422,
/// yuv422_yuy2; sensor_msgs/CompressedImage in JPEG and PNG.
///
/// The bag is read through once for its stamps, without decoding; afterwards only images that are asked for are in memory.
/// Streams share the bag and may be read from different threads. A message that cannot be read throws in its
/// StampedImage::load; one that has no readable stamp is left out and told of.
///
/// Throws InputError where bag, topics, types or encodings cannot be used.
std::vector<pipeline::CameraStream> openBag(const std::string& path, const std::vector<std::string>& topics,
                                            const io::RecordingOptions& options);

}  // namespace tartan_calib::ros
