#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

namespace tartan_calib::simulation {

/// Largest distance [px] between the image of a straight line and the chords drawn for it.
constexpr double kMaxChordErrorPx = 2e-4;

/// Points after `from_px`, up to and with `to_px`, of the image of a line. `project(s)` gives the pixel at fraction s of the
/// way, empty where there is none.
template <typename Project>
std::vector<Eigen::Vector2d> imageOfLine(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px,
                                         const Project& project) {
  constexpr int kMaxChords = 64;
  const Eigen::Vector2d chord = to_px - from_px;
  const auto middle = project(0.5);
  int num_chords = 1;
  if (middle && chord.squaredNorm() > 0.0) {
    const Eigen::Vector2d offset = *middle - from_px;
    const double sagitta_px = std::abs(chord.x() * offset.y() - chord.y() * offset.x()) / chord.norm();
    num_chords = static_cast<int>(std::min<double>(kMaxChords, std::ceil(std::sqrt(sagitta_px / kMaxChordErrorPx))));
  }
  std::vector<Eigen::Vector2d> points;
  for (int i = 1; i < num_chords; ++i) {
    if (const auto px = project(static_cast<double>(i) / num_chords)) {
      points.push_back(*px);
    }
  }
  points.push_back(to_px);
  return points;
}

}  // namespace tartan_calib::simulation
