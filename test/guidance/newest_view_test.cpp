#include "tartan_calib/guidance/newest_view.h"

#include <gtest/gtest.h>

namespace tartan_calib::guidance {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t kNsPerMs = 1'000'000;

class NewestViewTest : public testing::Test {
 protected:
  using Newest = NewestView<int>;

  static Newest::Time at(std::int64_t ms) { return Newest::Time(milliseconds(ms)); }

  /// An image whose stamp is its time of arrival, or an earlier one.
  static void add(Newest& newest, int camera_index, std::int64_t arrival_ms, std::int64_t stamp_ms) {
    newest.add({camera_index, stamp_ms * kNsPerMs, static_cast<int>(stamp_ms)}, at(arrival_ms));
  }

  static std::vector<int> stampsOf(const std::vector<Newest::Entry>& view) {
    std::vector<int> stamps_ms;
    for (const Newest::Entry& entry : view) {
      stamps_ms.push_back(entry.image);
    }
    return stamps_ms;
  }
};

TEST_F(NewestViewTest, ASlowConsumerNeverLags) {
  Newest newest(1, {});
  std::size_t num_taken = 0;
  for (int ms = 0; ms < 3000; ++ms) {  // 1000 images per second, one taken every 300 ms
    add(newest, 0, ms, ms);
    if (ms % 300 == 299) {
      EXPECT_EQ(stampsOf(newest.take(at(ms))), std::vector<int>{ms});
      ++num_taken;
    }
  }
  EXPECT_EQ(newest.numDropped(0), 3000 - num_taken);
}

TEST_F(NewestViewTest, NothingIsTakenTwice) {
  Newest newest(1, {});
  add(newest, 0, 0, 0);
  EXPECT_EQ(newest.take(at(0)).size(), 1u);
  EXPECT_TRUE(newest.take(at(1000)).empty());
}

TEST_F(NewestViewTest, WaitsForTheOtherCamerasImageOfTheSameTime) {
  Newest newest(2, {});
  add(newest, 0, 0, 0);
  add(newest, 1, 1, 0);
  EXPECT_EQ(newest.take(at(1)).size(), 2u);
  add(newest, 0, 50, 50);
  EXPECT_TRUE(newest.take(at(51)).empty());
  add(newest, 1, 60, 52);
  EXPECT_EQ(stampsOf(newest.take(at(60))), (std::vector<int>{50, 52}));
}

TEST_F(NewestViewTest, ACompleteViewGoesBeforeANewerImageAlone) {
  Newest newest(2, {});
  add(newest, 0, 0, 0);
  add(newest, 1, 40, 0);
  add(newest, 0, 50, 50);
  EXPECT_EQ(stampsOf(newest.take(at(51))), (std::vector<int>{0, 0}));
}

TEST_F(NewestViewTest, ACameraThatStopsIsNotWaitedForForEver) {
  Newest newest(2, {});
  add(newest, 0, 0, 0);
  add(newest, 1, 0, 0);
  EXPECT_EQ(newest.take(at(0)).size(), 2u);
  add(newest, 0, 50, 50);
  EXPECT_TRUE(newest.take(at(60)).empty());
  EXPECT_EQ(stampsOf(newest.take(at(160))), std::vector<int>{50});  // patience
  add(newest, 0, 2000, 2000);
  EXPECT_EQ(stampsOf(newest.take(at(2000))), std::vector<int>{2000});  // silent by now: at once
}

TEST_F(NewestViewTest, CamerasOutOfStepAreTakenOneByOne) {
  Newest newest(2, {});
  add(newest, 0, 0, 0);
  add(newest, 1, 50, 50);
  EXPECT_EQ(stampsOf(newest.take(at(120))), std::vector<int>{50});
  EXPECT_EQ(stampsOf(newest.take(at(121))), std::vector<int>{0});
}

TEST_F(NewestViewTest, AClockSetBackDoesNotStopIt) {
  Newest newest(1, {});
  add(newest, 0, 0, 5000);
  add(newest, 0, 10, 20);  // a bag that is played again
  EXPECT_EQ(stampsOf(newest.take(at(10))), std::vector<int>{20});
}

TEST_F(NewestViewTest, TakesNoMoreThanTheLargestRate) {
  NewestViewOptions options;
  options.max_rate_hz = 10.0;
  Newest newest(1, options);
  int num_taken = 0;
  for (int ms = 0; ms < 1000; ms += 5) {
    add(newest, 0, ms, ms);
    num_taken += newest.take(at(ms)).empty() ? 0 : 1;
  }
  EXPECT_EQ(num_taken, 10);
}

TEST_F(NewestViewTest, HoldsABoundedNumberOfImages) {
  Newest newest(2, {});
  for (int ms = 0; ms < 1000; ++ms) {
    add(newest, 0, ms, ms);
  }
  EXPECT_EQ(newest.numDropped(0), 1000 - NewestViewOptions::kMaxWaiting);
}

}  // namespace
}  // namespace tartan_calib::guidance
