#include "payload_patterns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tartan_calib::detection {
namespace {

constexpr std::array<double, 3> kBlurSigmasInCells = {0.4, 0.7, 1.1};
constexpr double kMinSpread = 0.15;  ///< rms of cells about their mean, where ink is -1 and paper 1: less is no payload

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Sum of squares about the mean.
double spread2(const std::vector<double>& values) {
  const double mean = meanOf(values);
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [mean](double sum, double value) { return sum + (value - mean) * (value - mean); });
}

/// Removes the mean and scales to length 1.
void normalize(std::vector<double>& values) {
  const double mean = meanOf(values);
  const double length = std::sqrt(std::max(spread2(values), 1e-12));
  for (double& value : values) {
    value = (value - mean) / length;
  }
}

/// Cells of a tag, 1 = white, -1 = black, under a Gaussian blur; all around is black border.
std::vector<double> blurredCells(const target::TagFamily& family, int tag_id, double sigma_cells) {
  const int n = family.payload_cells;
  std::vector<double> kernel;
  for (int d = 0; d < n; ++d) {
    kernel.push_back(std::exp(-0.5 * d * d / (sigma_cells * sigma_cells)));
  }
  std::vector<double> cells(static_cast<std::size_t>(n * n), -1.0);
  double kernel_sum = kernel[0];
  for (int d = 1; d < n; ++d) {
    kernel_sum += 2.0 * kernel[static_cast<std::size_t>(d)];
  }
  for (int i = 0; i < n * n; ++i) {
    for (int j = 0; j < n * n; ++j) {
      if (target::isWhiteCell(family, tag_id, j / n, j % n)) {
        cells[static_cast<std::size_t>(i)] += 2.0 * kernel[static_cast<std::size_t>(std::abs(i / n - j / n))] *
                                              kernel[static_cast<std::size_t>(std::abs(i % n - j % n))] /
                                              (kernel_sum * kernel_sum);
      }
    }
  }
  normalize(cells);
  return cells;
}

}  // namespace

PayloadPatterns::PayloadPatterns(const target::TagFamily& family, int first_id, int num_tags)
    : payload_cells_(family.payload_cells) {
  for (int tag = 0; tag < num_tags; ++tag) {
    std::vector<std::vector<double>> blurs;
    for (const double sigma_cells : kBlurSigmasInCells) {
      blurs.push_back(blurredCells(family, first_id + tag, sigma_cells));
    }
    patterns_.push_back(std::move(blurs));
  }
}

bool PayloadPatterns::isPayload(const std::vector<double>& cells) {
  return spread2(cells) >= kMinSpread * kMinSpread * static_cast<double>(cells.size());
}

double PayloadPatterns::correlation(const std::vector<double>& cells, int tag_index, int top_left) const {
  if (!isPayload(cells)) {
    return 0.0;
  }
  const int n = payload_cells_;
  std::vector<double> turned = cells;
  for (int turn = 0; turn < top_left; ++turn) {
    const std::vector<double> before = turned;
    for (int i = 0; i < n * n; ++i) {
      turned[static_cast<std::size_t>(i)] = before[static_cast<std::size_t>(i % n * n + n - 1 - i / n)];
    }
  }
  normalize(turned);
  double best = -1.0;
  for (const std::vector<double>& pattern : patterns_[static_cast<std::size_t>(tag_index)]) {
    double sum = 0.0;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
      sum += pattern[i] * turned[i];
    }
    best = std::max(best, sum);
  }
  return best;
}

}  // namespace tartan_calib::detection
