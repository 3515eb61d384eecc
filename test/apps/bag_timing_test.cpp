#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "inspect_bag/timing.h"

namespace tartan_calib::apps {
namespace {

constexpr std::int64_t kStart_ns = 1'600'000'000'000'000'000;
constexpr std::int64_t kMs = 1'000'000;

/// Images stamped at these times, received 5 ms later.
std::vector<ros::ImageRecord> imagesAt(const std::vector<std::int64_t>& times_ms) {
  std::vector<ros::ImageRecord> images;
  for (const std::int64_t time_ms : times_ms) {
    images.push_back({kStart_ns + (time_ms + 5) * kMs, kStart_ns + time_ms * kMs, 64, 48, "mono8"});
  }
  return images;
}

std::vector<std::int64_t> stampsEvery(std::int64_t period_ms, int count, std::int64_t first_ms = 0) {
  std::vector<std::int64_t> stamps_ns;
  for (int i = 0; i < count; ++i) {
    stamps_ns.push_back(kStart_ns + (first_ms + i * period_ms) * kMs);
  }
  return stamps_ns;
}

TEST(TopicTiming, FindsGapsAndWhatIsMissingInThem) {
  const TopicTiming timing = timingOf(imagesAt({0, 50, 101, 150, 300, 350, 400, 450, 550}));
  EXPECT_TRUE(timing.is_regular);
  EXPECT_NEAR(timing.period_s, 0.05, 1e-12);
  EXPECT_NEAR(timing.duration_s, 0.55, 1e-12);
  EXPECT_EQ(timing.num_gaps, 2U);
  EXPECT_EQ(timing.num_missing, 3U);
  EXPECT_NEAR(timing.longest_gap_s, 0.15, 1e-12);
  EXPECT_NEAR(timing.longest_gap_at_s, 0.15, 1e-12);
  EXPECT_NEAR(timing.jitter_s, 0.001, 1e-12);
  EXPECT_NEAR(timing.median_delay_s, 0.005, 1e-12);
}

TEST(TopicTiming, HasNoGapsWhereImagesComeAtNoRate) {
  const TopicTiming timing = timingOf(imagesAt({0, 70, 250, 300, 900, 1000, 1700, 2100}));
  EXPECT_FALSE(timing.is_regular);
  EXPECT_EQ(timing.num_gaps, 0U);
}

TEST(TopicTiming, CountsStampsThatAreOutOfOrderRepeatedOrMissing) {
  std::vector<ros::ImageRecord> images = imagesAt({0, 100, 50, 150, 150, 200});
  images.back().stamp_ns = 0;
  const TopicTiming timing = timingOf(images);
  EXPECT_EQ(timing.num_backwards, 1U);
  EXPECT_EQ(timing.num_repeated, 1U);
  EXPECT_EQ(timing.num_unstamped, 1U);
  EXPECT_NEAR(timing.period_s, 0.05, 1e-12) << "an image without a stamp counts when it was received";
}

TEST(TopicTiming, OfOneImageIsNothing) {
  const TopicTiming timing = timingOf(imagesAt({10}));
  EXPECT_EQ(timing.period_s, 0.0);
  EXPECT_FALSE(timing.is_regular);
}

TEST(Synchronization, IsTheOffsetOfTheNearestStamps) {
  const Synchronization sync = synchronizationOf(stampsEvery(50, 100), stampsEvery(50, 100, 4));
  EXPECT_NEAR(sync.median_offset_s, 0.004, 1e-12);
  EXPECT_NEAR(sync.p95_offset_s, 0.004, 1e-12);
  EXPECT_NEAR(sync.max_offset_s, 0.004, 1e-12);
  EXPECT_NEAR(sync.half_period_s, 0.025, 1e-12);
  EXPECT_EQ(sync.within_half_ratio, 1.0);
  EXPECT_LT(sync.apart_s, 0.0);
}

TEST(Synchronization, HoldsTheSlowerCameraAgainstTheFaster) {
  for (const bool is_swapped : {false, true}) {
    const std::vector<std::int64_t> fast = stampsEvery(10, 500);
    const std::vector<std::int64_t> slow = stampsEvery(100, 50, 3);
    const Synchronization sync = is_swapped ? synchronizationOf(slow, fast) : synchronizationOf(fast, slow);
    EXPECT_NEAR(sync.median_offset_s, is_swapped ? -0.003 : 0.003, 1e-12);
    EXPECT_NEAR(sync.half_period_s, 0.005, 1e-12);
    EXPECT_EQ(sync.within_half_ratio, 1.0);
  }
}

TEST(Synchronization, CountsImagesWithoutPartner) {
  const std::vector<std::int64_t> all = stampsEvery(50, 100);
  std::vector<std::int64_t> part = stampsEvery(50, 60, 1);
  part.insert(part.end(), {all[90] + kMs, all[95] + kMs});
  EXPECT_EQ(synchronizationOf(all, part).within_half_ratio, 1.0) << "the camera with fewer images lacks none";
  const Synchronization apart = synchronizationOf(all, stampsEvery(50, 100, 60'000));
  EXPECT_EQ(apart.within_half_ratio, 0.0);
  EXPECT_NEAR(apart.apart_s, 60.0 - 4.95, 1e-9);
}

TEST(Samples, AreFewAndEvenInTime) {
  EXPECT_EQ(evenlyInTime(stampsEvery(10, 7), 40).size(), 7U);
  std::vector<std::int64_t> stamps = stampsEvery(1, 5000);  // a burst, then a long slow part
  const std::vector<std::int64_t> slow = stampsEvery(100, 950, 5000);
  stamps.insert(stamps.end(), slow.begin(), slow.end());
  const std::vector<std::size_t> indices = evenlyInTime(stamps, 40);
  EXPECT_EQ(indices.size(), 40U);
  for (std::size_t i = 1; i < indices.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(stamps[indices[i]] - stamps[indices[i - 1]]), 2.5e9, 0.2e9);
  }
}

}  // namespace
}  // namespace tartan_calib::apps
