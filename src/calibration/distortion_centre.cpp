#include "distortion_centre.h"

#include <algorithm>
#include <array>
#include <optional>

#include "tartan_calib/solver/parallel.h"

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

const CentreFit& bestOf(const CentreFit& guess, const std::vector<CentreFit>& fits) {
  const auto best =
      std::min_element(fits.begin(), fits.end(), [](const CentreFit& a, const CentreFit& b) { return a.cost < b.cost; });
  return best->cost < guess.cost ? *best : guess;
}

/// The best of the guess and the 8 points around it.
CentreFit bestOfGrid(const std::vector<NormalView>& views, const CentreFit& guess, double spacing, int num_threads) {
  std::vector<Eigen::Vector2d> offsets;
  for (int row = -1; row <= 1; ++row) {
    for (int col = -1; col <= 1; ++col) {
      if (row != 0 || col != 0) {
        offsets.emplace_back(col, row);
      }
    }
  }
  std::vector<CentreFit> fits(offsets.size());
  solver::forEachItem(static_cast<int>(offsets.size()), num_threads,
                      [&](std::size_t i) { fits[i] = searchAround(views, guess.centre + spacing * offsets[i]); });
  return bestOf(guess, fits);
}

/// Pattern search: steps along the axes, halved where none helps, within `max_offset` of the guess.
CentreFit descend(const std::vector<NormalView>& views, CentreFit best, const Eigen::Vector2d& guess, double max_offset,
                  int num_threads) {
  const std::array<Eigen::Vector2d, 4> directions = {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, 1),
                                                     Eigen::Vector2d(0, -1)};
  for (double step = 0.25 * max_offset; step > kSmallestStep;) {
    std::vector<CentreFit> fits(directions.size(), best);
    solver::forEachItem(static_cast<int>(directions.size()), num_threads, [&](std::size_t i) {
      const Eigen::Vector2d centre = best.centre + step * directions[i];
      if ((centre - guess).cwiseAbs().maxCoeff() <= max_offset) {
        fits[i] = refineAround(views, best, centre);
      }
    });
    const CentreFit& better = bestOf(best, fits);
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
                                                   double max_offset, int num_threads) {
  const CentreFit start = searchAround(views, guess);
  const CentreFit nearby = bestOfGrid(views, start, 2.0 / 3.0 * max_offset, num_threads);
  const CentreFit best = descend(views, nearby, guess, max_offset, num_threads);
  if (best.cost < kClearlyBetter * start.cost) {
    return {best.centre, guess};
  }
  return {guess};
}

}  // namespace tartan_calib::calibration
