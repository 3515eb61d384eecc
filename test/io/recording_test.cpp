#include "tartan_calib/io/recording.h"

#include <gtest/gtest.h>

namespace tartan_calib::io {
namespace {

using Times = std::vector<std::int64_t>;

constexpr std::int64_t kMs = 1'000'000;

/// Milliseconds at which each topic keeps an image, of those at which it has one.
std::vector<Times> kept(const std::vector<Times>& topics_ms, double max_rate_hz) {
  std::vector<TopicStamps> topics;
  for (const Times& times_ms : topics_ms) {
    topics.push_back({"/cam" + std::to_string(topics.size()), {}});
    for (const std::int64_t time_ms : times_ms) {
      topics.back().stamps_ns.push_back(time_ms * kMs);
    }
  }
  RecordingOptions options;
  options.max_rate_hz = max_rate_hz;
  std::vector<Times> result;
  for (const std::vector<std::size_t>& selected : selectImages(topics, options)) {
    const Times& times_ms = topics_ms[result.size()];
    result.emplace_back();
    for (const std::size_t i : selected) {
      result.back().push_back(times_ms[i]);
    }
  }
  return result;
}

TEST(SelectImages, KeepsCamerasTogetherAfterAGapInOne) {
  const std::vector<Times> topics_ms{{0, 50, 100, 150, 200, 250, 300, 350, 400}, {1, 51, 151, 201, 251, 301, 351, 401}};
  EXPECT_EQ(kept(topics_ms, 10.0), (std::vector<Times>{{0, 100, 200, 300, 400}, {1, 51, 201, 301, 401}}));
}

TEST(SelectImages, KeepsCamerasTogetherWhereThePeriodIsNearlyMet) {
  const std::vector<Times> topics_ms{{0, 50, 99, 150, 200, 250}, {1, 50, 101, 149, 199, 250}};
  EXPECT_EQ(kept(topics_ms, 10.0), (std::vector<Times>{{0, 99, 250}, {1, 101, 250}}));
}

TEST(SelectImages, KeepsAllImagesOfCamerasOutOfStepWhereTheRateIsHigh) {
  const std::vector<Times> topics_ms{{0, 100, 200, 300}, {7, 107, 207, 307}};
  EXPECT_EQ(kept(topics_ms, 100.0), topics_ms);
}

TEST(SelectImages, KeepsASlowCameraWhole) {
  const std::vector<Times> topics_ms{{0, 50, 100, 150, 200, 250, 300, 350, 400}, {30, 330}};
  EXPECT_EQ(kept(topics_ms, 10.0), (std::vector<Times>{{0, 100, 200, 300, 400}, {30, 330}}));
}

}  // namespace
}  // namespace tartan_calib::io
