#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <random>

namespace tartan_calib::simulation {

/// Random numbers that are the same with every standard library (its distributions are not).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [low, high).
  double uniform(double low, double high) {
    constexpr double kPerStep = 1.0 / 9007199254740992.0;  // 2^-53
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * kPerStep;
  }

  /// Standard normal (Box and Muller 1958).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0.0, 1.0)));
    return radius * std::cos(uniform(0.0, 2.0 * M_PI));
  }

  Eigen::Vector3d normalVector() {
    const double x = normal();
    const double y = normal();
    return {x, y, normal()};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace tartan_calib::simulation
