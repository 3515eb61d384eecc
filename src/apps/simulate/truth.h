#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "tartan_calib/pipeline/calibrate.h"
#include "tartan_calib/simulation/renderer.h"

namespace tartan_calib::apps {

/// Collects what a recording shows, to write it in the formats of a calibration.
class Truth {
 public:
  explicit Truth(const simulation::Scene& scene);

  void add(const simulation::RenderedFrame& frame);

  std::size_t numCorners() const;
  std::size_t numVisibleCorners() const;

  /// `<base>-target.yaml`, `<base>-truth-camchain.yaml`, `-truth-poses.csv`, `-truth-corners.csv` and
  /// `-truth-visibility.csv`.
  void save(const std::string& base) const;

 private:
  simulation::Scene scene_;
  std::vector<pipeline::CameraCorners> cameras_;
  std::ostringstream visibility_;
};

}  // namespace tartan_calib::apps
