#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace tartan_calib::calibration {

/// Weight of a residual under Cauchy's loss, for iteratively reweighted least squares.
inline double cauchyWeight(double residual, double scale) {
  const double ratio = residual / scale;
  return 1.0 / (1.0 + ratio * ratio);
}

/// Minimises sum w_i |v_i - x| over x. Reorders `value_weights`, which must not be empty; weights are not negative.
inline double weightedMedian(std::vector<std::pair<double, double>>& value_weights) {
  std::sort(value_weights.begin(), value_weights.end());
  double total = 0.0;
  for (const auto& [value, weight] : value_weights) {
    total += weight;
  }
  double sum = 0.0;
  for (const auto& [value, weight] : value_weights) {
    sum += weight;
    if (sum >= 0.5 * total) {
      return value;
    }
  }
  return value_weights.back().first;
}

/// Indices for random samples, the same on every platform.
class Sampler {
 public:
  /// `count` different indices below `size`, `count` <= `size`.
  template <typename Indices>
  void draw(std::size_t size, Indices& indices) {
    for (auto it = indices.begin(); it != indices.end();) {
      *it = generator_() % size;
      if (std::find(indices.begin(), it, *it) == it) {
        ++it;
      }
    }
  }

 private:
  std::mt19937 generator_;  // fixed default seed
};

}  // namespace tartan_calib::calibration
