#pragma once

#include <cstddef>
#include <string>

#include "common/progress_bar.h"
#include "simulate/simulate_options.h"
#include "tartan_calib/simulation/scene.h"

namespace tartan_calib::apps {

struct SimulateSummary {
  std::size_t num_images = 0;
  std::size_t num_corners = 0;          ///< within an image
  std::size_t num_visible_corners = 0;  ///< of them
  std::string base;                     ///< the files of the truth start with it
};

/// The scene that the options describe. Throws InputError.
simulation::Scene makeScene(const SimulateOptions& options);

/// Renders it and writes recording and truth; the recording appears last, when everything else is there. Where it is
/// interrupted nothing is left behind. `progress` is told of the views.
SimulateSummary simulate(const SimulateOptions& options, const ProgressCall& progress = {});

}  // namespace tartan_calib::apps
