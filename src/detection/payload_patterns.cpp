#include "payload_patterns.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tartan_calib::detection {
namespace {

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

PayloadPatterns::PayloadPatterns(const target::TagFamily& family, int first_id, int num_tags,
                                 const std::vector<double>& blur_sigmas_cells)
    : payload_cells_(family.payload_cells) {
  for (int tag = 0; tag < num_tags; ++tag) {
    std::vector<std::vector<double>> blurs;
    for (const double sigma_cells : blur_sigmas_cells) {
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
  std::vector<double> upright = turned(cells, top_left);
  normalize(upright);
  return bestOverBlurs(upright, tag_index);
}

PayloadPatterns::Likeness PayloadPatterns::mostAlike(const std::vector<double>& cells) const {
  constexpr int kTurns = 4;
  std::vector<double> normalized = cells;
  normalize(normalized);
  Likeness best;
  for (int top_left = 0; top_left < kTurns; ++top_left) {
    const std::vector<double> upright = turned(normalized, top_left);
    for (int tag = 0; tag < static_cast<int>(patterns_.size()); ++tag) {
      const double correlation = bestOverBlurs(upright, tag);
      if (correlation > best.correlation) {
        best = {tag, top_left, correlation};
      }
    }
  }
  return best;
}

std::vector<double> PayloadPatterns::turned(std::vector<double> cells, int top_left) const {
  const int n = payload_cells_;
  for (int turn = 0; turn < top_left; ++turn) {
    const std::vector<double> before = cells;
    for (int i = 0; i < n * n; ++i) {
      cells[static_cast<std::size_t>(i)] = before[static_cast<std::size_t>(i % n * n + n - 1 - i / n)];
    }
  }
  return cells;
}

double PayloadPatterns::bestOverBlurs(const std::vector<double>& normalized_cells, int tag_index) const {
  double best = -1.0;
  for (const std::vector<double>& pattern : patterns_[static_cast<std::size_t>(tag_index)]) {
    best = std::max(best, std::inner_product(pattern.begin(), pattern.end(), normalized_cells.begin(), 0.0));
  }
  return best;
}

}  // namespace tartan_calib::detection
