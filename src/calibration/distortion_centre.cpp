#include "distortion_centre.h"

#include <algorithm>
#include <optional>

namespace tartan_calib::calibration {
namespace {

/// Of the guess's cost: at most this much is worth a second centre.
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

/// The best of the guess and the 8 points around it.
CentreFit bestOfGrid(const std::vector<NormalView>& views, const CentreFit& guess, double spacing) {
  CentreFit best = guess;
  for (int row = -1; row <= 1; ++row) {
    for (int col = -1; col <= 1; ++col) {
      if (row == 0 && col == 0) {
        continue;
      }
      const CentreFit fit = searchAround(views, guess.centre + spacing * Eigen::Vector2d(col, row));
      if (fit.cost < best.cost) {
        best = fit;
      }
    }
  }
  return best;
}

/// Pattern search: steps along the axes, halved where none helps, within `max_offset` of the guess.
CentreFit descend(const std::vector<NormalView>& views, CentreFit best, const Eigen::Vector2d& guess, double max_offset) {
  for (double step = 0.25 * max_offset; step > kSmallestStep;) {
    CentreFit better = best;
    for (const Eigen::Vector2d& direction :
         {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, 1), Eigen::Vector2d(0, -1)}) {
      const Eigen::Vector2d centre = best.centre + step * direction;
      if ((centre - guess).cwiseAbs().maxCoeff() > max_offset) {
        continue;
      }
      const CentreFit fit = refineAround(views, best, centre);
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

std::vector<Eigen::Vector2d> findDistortionCentres(const std::vector<NormalView>& views, const Eigen::Vector2d& guess,
                                                   double max_offset) {
  const CentreFit start = searchAround(views, guess);
  const CentreFit best = descend(views, bestOfGrid(views, start, 2.0 / 3.0 * max_offset), guess, max_offset);
  if (best.cost < kClearlyBetter * start.cost) {
    return {best.centre, guess};
  }
  return {guess};
}

}  // namespace tartan_calib::calibration
