#pragma once

#include <cstddef>
#include <vector>

namespace tartan_calib::calibration {

/// `count` of the items at even distances, or all where there are not more.
template <typename T>
std::vector<T> spread(const std::vector<T>& items, std::size_t count) {
  if (items.size() <= count) {
    return items;
  }
  std::vector<T> result;
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back(items[i * items.size() / count]);
  }
  return result;
}

}  // namespace tartan_calib::calibration
