#pragma once

#include <cstdint>
#include <vector>

#include "tartan_calib/ros/bag_contents.h"

namespace tartan_calib::apps {

/// When the images of a topic were taken, by the stamps of their headers.
struct TopicTiming {
  double duration_s = 0.0;
  double period_s = 0.0;    ///< median distance from stamp to stamp; 0 with fewer than two images
  double jitter_s = 0.0;    ///< 95 % of these distances are so near to the median; gaps apart
  bool is_regular = false;  ///< half of the distances or more are like the median; only then there are gaps
  std::size_t num_gaps = 0;
  std::size_t num_missing = 0;  ///< images that would fill the gaps
  double longest_gap_s = 0.0;
  double longest_gap_at_s = 0.0;  ///< its start, after the first image
  std::size_t num_unstamped = 0;
  std::size_t num_backwards = 0;  ///< stamped before the image that was received before
  std::size_t num_repeated = 0;   ///< stamped as another image
  double median_delay_s = 0.0;    ///< from stamp to receipt
  double min_delay_s = 0.0;
  double max_delay_s = 0.0;
};

/// `images` as received; there must be some.
TopicTiming timingOf(const std::vector<ros::ImageRecord>& images);

/// Stamps by increasing time; the time of receipt where the header has none, as a calibration takes it.
std::vector<std::int64_t> sortedStamps(const std::vector<ros::ImageRecord>& images);

/// How far images of one camera are from the nearest ones of another.
struct Synchronization {
  double median_offset_s = 0.0;    ///< signed; positive where the other camera is later
  double p95_offset_s = 0.0;       ///< of the absolute offsets
  double max_offset_s = 0.0;       ///< of those within half a period
  double half_period_s = 0.0;      ///< of the camera with more images
  double within_half_ratio = 0.0;  ///< images with a partner within half a period
  double apart_s = 0.0;  ///< from the last image of the earlier camera to the first of the later; <= 0: they overlap
};

/// The camera with fewer images is held against the other. Both need images, by increasing stamp.
Synchronization synchronizationOf(const std::vector<std::int64_t>& reference_ns, const std::vector<std::int64_t>& other_ns);

/// Indices of at most `max_count` of the stamps, evenly in time.
std::vector<std::size_t> evenlyInTime(const std::vector<std::int64_t>& stamps_ns, std::size_t max_count);

}  // namespace tartan_calib::apps
