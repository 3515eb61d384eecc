#include "symmetric_window.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tartan_calib::detection {
namespace {

constexpr double kSampleSpacing_px = 0.8;
constexpr double kMaxReach = 4.0;  ///< of a half window along an axis, in largest ones: more is no map of a board

/// Half of the window in board units along one board axis.
double axisHalfWindow(const BoardToPixelOffset& map, const Eigen::Vector2d& axis, const RefineOptions& options) {
  const double length_px = 0.5 * (map(options.half_window * axis) - map(-options.half_window * axis)).norm();
  if (!(length_px > 0.0)) {
    return 0.0;
  }
  const double min_px = options.scale_px * options.min_half_window_px;
  const double max_px = options.scale_px * options.max_half_window_px;
  return options.half_window * std::clamp(length_px, min_px, max_px) / length_px;
}

/// Value, slope and curvature of the parabola through values at -1, 0 and 1.
template <typename T>
std::array<T, 3> parabola(const T& before, const T& middle, const T& after) {
  return {middle, T(0.5 * (after - before)), T(0.5 * (after + before) - middle)};
}

bool isInside(const cv::Size& image, const Eigen::Vector2d& px) {
  return px.x() >= 0.0 && px.y() >= 0.0 && px.x() <= image.width - 1 && px.y() <= image.height - 1;
}

}  // namespace

std::optional<SymmetricWindow> SymmetricWindow::make(const BoardToPixelOffset& map, const RefineOptions& options) {
  const double half_u = axisHalfWindow(map, Eigen::Vector2d::UnitX(), options);
  const double half_v = axisHalfWindow(map, Eigen::Vector2d::UnitY(), options);
  const auto seen = [&](int u, int v) -> Eigen::Vector2d { return map({u * half_u, v * half_v}); };
  std::array<std::array<Eigen::Vector2d, 3>, 3> rows;
  for (const int v : {-1, 0, 1}) {
    rows[static_cast<std::size_t>(v + 1)] = parabola<Eigen::Vector2d>(seen(-1, v), seen(0, v), seen(1, v));
  }
  SymmetricWindow window;
  for (int i = 0; i < 3; ++i) {
    const auto power = static_cast<std::size_t>(i);
    const auto column = parabola<Eigen::Vector2d>(rows[0][power], rows[1][power], rows[2][power]);
    for (int j = 0; j < 3; ++j) {
      window.coefficients_.col(3 * j + i) = column[static_cast<std::size_t>(j)];
    }
  }
  window.length_px_ << window.coefficients_.col(1).norm(), window.coefficients_.col(3).norm();
  window.min_half_window_px_ = options.scale_px * options.min_half_window_px;
  window.spacing_px_ = options.scale_px * kSampleSpacing_px;
  const double max_length_px = kMaxReach * options.scale_px * options.max_half_window_px;
  const bool is_usable = window.coefficients_.allFinite() && window.length_px_.minCoeff() > 0.0 &&
                         window.coefficients_.cwiseAbs().maxCoeff() < max_length_px;
  return is_usable ? std::make_optional(window) : std::nullopt;
}

Eigen::Vector2d SymmetricWindow::at(double u, double v) const {
  Eigen::Matrix<double, 9, 1> powers;
  powers << 1.0, u, u * u, v, u * v, u * u * v, v * v, u * v * v, u * u * v * v;
  return coefficients_ * powers;
}

SampleSet SymmetricWindow::samples(double share, const Eigen::Vector2d& centre_px, const cv::Size& image) const {
  const Eigen::Vector2d size = (min_half_window_px_ * length_px_.cwiseInverse()).cwiseMin(1.0).cwiseMax(share);
  const Eigen::Vector2d half_px = size.cwiseProduct(length_px_);
  const int num_u = std::max(2, static_cast<int>(std::ceil(half_px.x() / spacing_px_)));
  const int num_v = std::max(2, static_cast<int>(std::ceil(half_px.y() / spacing_px_)));
  SampleSet set;
  set.pairs.reserve(static_cast<std::size_t>((2 * num_u + 1) * (num_v + 1)));
  for (int j = 0; j <= num_v; ++j) {
    for (int i = j == 0 ? 1 : -num_u; i <= num_u; ++i) {
      const double u = size.x() * i / num_u;
      const double v = size.y() * j / num_v;
      const Eigen::Vector2d plus_px = at(u, v);
      const Eigen::Vector2d minus_px = at(-u, -v);
      if (isInside(image, centre_px + plus_px) && isInside(image, centre_px + minus_px)) {
        set.pairs.push_back({plus_px.cast<float>(), minus_px.cast<float>()});
        set.reach_px = std::max({set.reach_px, plus_px.cwiseAbs().maxCoeff(), minus_px.cwiseAbs().maxCoeff()});
      }
    }
  }
  const Eigen::Vector2d u_px = size.x() / num_u * coefficients_.col(1);
  const Eigen::Vector2d v_px = size.y() / num_v * coefficients_.col(3);
  set.pairs_per_px2 = 1.0 / std::max(std::abs(u_px.x() * v_px.y() - u_px.y() * v_px.x()), 1e-3);
  return set;
}

}  // namespace tartan_calib::detection
