#pragma once

#include <algorithm>
#include <vector>

namespace tartan_calib {

/// Upper median. Reorders `values`, which must not be empty.
inline double upperMedian(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace tartan_calib
