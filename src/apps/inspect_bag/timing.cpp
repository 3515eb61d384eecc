#include "inspect_bag/timing.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tartan_calib/median.h"

namespace tartan_calib::apps {
namespace {

constexpr double kSecondsPerNs = 1e-9;
/// Of the median period; longer means that at least one image is missing.
constexpr double kGap_ratio = 1.5;
/// Of the median period, for periods that count as the same.
constexpr double kAlike_ratio = 0.1;
constexpr double kMost_ratio = 0.95;

double seconds(std::int64_t duration_ns) { return kSecondsPerNs * static_cast<double>(duration_ns); }

/// Needs values.
double quantile(std::vector<double> values, double ratio) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(ratio * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double medianPeriod(const std::vector<std::int64_t>& stamps_ns) {
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) {
    if (stamps_ns[i] != stamps_ns[i - 1]) {
      periods_s.push_back(seconds(stamps_ns[i] - stamps_ns[i - 1]));
    }
  }
  return periods_s.empty() ? 0.0 : upperMedian(periods_s);
}

void addGaps(const std::vector<std::int64_t>& stamps_ns, TopicTiming& timing) {
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) {
    const double distance_s = seconds(stamps_ns[i] - stamps_ns[i - 1]);
    if (distance_s < kGap_ratio * timing.period_s) {
      continue;
    }
    ++timing.num_gaps;
    timing.num_missing += static_cast<std::size_t>(std::max(std::lround(distance_s / timing.period_s) - 1L, 1L));
    if (distance_s > timing.longest_gap_s) {
      timing.longest_gap_s = distance_s;
      timing.longest_gap_at_s = seconds(stamps_ns[i - 1] - stamps_ns.front());
    }
  }
}

void addPeriods(const std::vector<std::int64_t>& stamps_ns, TopicTiming& timing) {
  timing.duration_s = seconds(stamps_ns.back() - stamps_ns.front());
  timing.period_s = medianPeriod(stamps_ns);
  std::vector<double> deviations_s;
  std::size_t num_alike = 0;
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) {
    const double distance_s = seconds(stamps_ns[i] - stamps_ns[i - 1]);
    const double deviation_s = std::abs(distance_s - timing.period_s);
    if (stamps_ns[i] == stamps_ns[i - 1]) {
      ++timing.num_repeated;
    } else if (distance_s < kGap_ratio * timing.period_s) {
      deviations_s.push_back(deviation_s);
      num_alike += deviation_s < kAlike_ratio * timing.period_s ? 1U : 0U;
    }
  }
  timing.jitter_s = deviations_s.empty() ? 0.0 : quantile(deviations_s, kMost_ratio);
  timing.is_regular = timing.period_s > 0.0 && 2 * num_alike >= stamps_ns.size() - 1 - timing.num_repeated;
  if (timing.is_regular) {
    addGaps(stamps_ns, timing);
  }
}

void addReceipt(const std::vector<ros::ImageRecord>& images, TopicTiming& timing) {
  std::vector<double> delays_s;
  std::int64_t before_ns = 0;
  for (const ros::ImageRecord& image : images) {
    if (image.stamp_ns == 0) {
      ++timing.num_unstamped;
      continue;
    }
    timing.num_backwards += image.stamp_ns < before_ns ? 1U : 0U;
    before_ns = image.stamp_ns;
    delays_s.push_back(seconds(image.received_ns - image.stamp_ns));
  }
  if (!delays_s.empty()) {
    timing.min_delay_s = *std::min_element(delays_s.begin(), delays_s.end());
    timing.max_delay_s = *std::max_element(delays_s.begin(), delays_s.end());
    timing.median_delay_s = upperMedian(delays_s);
  }
}

/// Later than `stamp_ns` where positive. `stamps_ns` is sorted and not empty.
std::int64_t offsetOfNearest(const std::vector<std::int64_t>& stamps_ns, std::int64_t stamp_ns) {
  const auto next = std::lower_bound(stamps_ns.begin(), stamps_ns.end(), stamp_ns);
  if (next == stamps_ns.begin()) {
    return *next - stamp_ns;
  }
  const std::int64_t before_ns = *(next - 1) - stamp_ns;
  return next == stamps_ns.end() || -before_ns <= *next - stamp_ns ? before_ns : *next - stamp_ns;
}

}  // namespace

TopicTiming timingOf(const std::vector<ros::ImageRecord>& images) {
  TopicTiming timing;
  addPeriods(sortedStamps(images), timing);
  addReceipt(images, timing);
  return timing;
}

std::vector<std::int64_t> sortedStamps(const std::vector<ros::ImageRecord>& images) {
  std::vector<std::int64_t> stamps_ns;
  stamps_ns.reserve(images.size());
  for (const ros::ImageRecord& image : images) {
    stamps_ns.push_back(image.stamp_ns != 0 ? image.stamp_ns : image.received_ns);
  }
  std::sort(stamps_ns.begin(), stamps_ns.end());
  return stamps_ns;
}

Synchronization synchronizationOf(const std::vector<std::int64_t>& reference_ns, const std::vector<std::int64_t>& other_ns) {
  const bool is_other_rarer = other_ns.size() < reference_ns.size();
  const std::vector<std::int64_t>& rarer = is_other_rarer ? other_ns : reference_ns;
  const std::vector<std::int64_t>& denser = is_other_rarer ? reference_ns : other_ns;
  std::vector<double> offsets_s;
  std::vector<double> sizes_s;
  Synchronization sync;
  sync.half_period_s = 0.5 * medianPeriod(denser);
  std::size_t num_within = 0;
  for (const std::int64_t stamp_ns : rarer) {
    const double offset_s = seconds(offsetOfNearest(denser, stamp_ns));
    offsets_s.push_back(is_other_rarer ? -offset_s : offset_s);
    sizes_s.push_back(std::abs(offset_s));
    if (std::abs(offset_s) <= sync.half_period_s) {
      ++num_within;
      sync.max_offset_s = std::max(sync.max_offset_s, std::abs(offset_s));
    }
  }
  sync.median_offset_s = upperMedian(offsets_s);
  sync.p95_offset_s = quantile(sizes_s, kMost_ratio);
  sync.within_half_ratio = static_cast<double>(num_within) / static_cast<double>(rarer.size());
  sync.apart_s = seconds(std::max(reference_ns.front() - other_ns.back(), other_ns.front() - reference_ns.back()));
  return sync;
}

std::vector<std::size_t> evenlyInTime(const std::vector<std::int64_t>& stamps_ns, std::size_t max_count) {
  std::vector<std::size_t> indices;
  if (stamps_ns.size() <= max_count) {
    for (std::size_t i = 0; i < stamps_ns.size(); ++i) {
      indices.push_back(i);
    }
    return indices;
  }
  const double step_ns = static_cast<double>(stamps_ns.back() - stamps_ns.front()) / static_cast<double>(max_count);
  for (std::size_t k = 0; k < max_count; ++k) {  // the first image at or after the middle of each part, none twice
    const auto middle_ns = stamps_ns.front() + static_cast<std::int64_t>((static_cast<double>(k) + 0.5) * step_ns);
    const auto found = std::lower_bound(stamps_ns.begin(), stamps_ns.end(), middle_ns);
    const auto index = static_cast<std::size_t>(found - stamps_ns.begin());
    if (index < stamps_ns.size() && (indices.empty() || indices.back() < index)) {
      indices.push_back(index);
    }
  }
  return indices;
}

}  // namespace tartan_calib::apps
