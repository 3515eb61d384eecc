#include "distortion_centre.h"

#include <algorithm>
#include <optional>

namespace tartan_calib::calibration {
namespace {

/// A better centre must lower the cost to this share of the guess's.
constexpr double kClearlyBetter = 0.8;
constexpr double kSmallestStep = 1e-3;  // of half the image's width

/// The views' homographies around a centre, and how well they do.
struct CentreFit {
  Eigen::Vector2d centre;
  std::vector<RadialHomography> homographies;
  double cost = 0.0;
};

double meanCost(const std::vector<NormalView>& views, const CentreFit& fit) {
  double sum = 0.0;
  double num_corners = 0.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto size = static_cast<double>(views[i].size());
    sum += size * radialCost(fit.homographies[i], fit.centre, views[i]);
    num_corners += size;
  }
  return sum / num_corners;
}

CentreFit searchAround(const std::vector<NormalView>& views, const Eigen::Vector2d& centre) {
  CentreFit fit;
  fit.centre = centre;
  for (const NormalView& view : views) {
    fit.homographies.push_back(searchRadialHomography(view, centre).value_or(RadialHomography::Zero()));
  }
  fit.cost = meanCost(views, fit);
  return fit;
}

CentreFit refineAround(const std::vector<NormalView>& views, const CentreFit& neighbour, const Eigen::Vector2d& centre) {
  CentreFit fit;
  fit.centre = centre;
  for (std::size_t i = 0; i < views.size(); ++i) {
    fit.homographies.push_back(refineRadialHomography(views[i], centre, neighbour.homographies[i]));
  }
  fit.cost = meanCost(views, fit);
  return fit;
}

/// The best of a grid, without the guess.
CentreFit bestOfGrid(const std::vector<NormalView>& views, const CentreFit& guess, double max_offset) {
  constexpr int kHalfSteps = 2;
  CentreFit best = guess;
  for (int row = -kHalfSteps; row <= kHalfSteps; ++row) {
    for (int col = -kHalfSteps; col <= kHalfSteps; ++col) {
      if (row == 0 && col == 0) {
        continue;
      }
      const Eigen::Vector2d offset(col * max_offset / kHalfSteps, row * max_offset / kHalfSteps);
      const CentreFit fit = searchAround(views, guess.centre + offset);
      if (fit.cost < best.cost) {
        best = fit;
      }
    }
  }
  return best;
}

/// Pattern search: steps along the axes, halved where none helps.
CentreFit descend(const std::vector<NormalView>& views, CentreFit best, double first_step) {
  for (double step = first_step; step > kSmallestStep;) {
    CentreFit better = best;
    for (const Eigen::Vector2d& direction :
         {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, 1), Eigen::Vector2d(0, -1)}) {
      const CentreFit fit = refineAround(views, best, best.centre + step * direction);
      if (fit.cost < better.cost) {
        better = fit;
      }
    }
    if (better.cost < best.cost) {
      best = better;
    } else {
      step *= 0.5;
    }
  }
  return best;
}

}  // namespace

Eigen::Vector2d findDistortionCentre(const std::vector<NormalView>& views, const Eigen::Vector2d& guess, double max_offset) {
  const CentreFit start = searchAround(views, guess);
  const CentreFit best = descend(views, bestOfGrid(views, start, max_offset), 0.25 * max_offset);
  return best.cost < kClearlyBetter * start.cost ? best.centre : guess;
}

}  // namespace tartan_calib::calibration
