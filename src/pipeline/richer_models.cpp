#include "tartan_calib/pipeline/richer_models.h"

namespace tartan_calib::pipeline {

std::string richerModels(const std::string& model) {
  if (model == "pinhole-none") {
    return "try pinhole-radtan";
  }
  if (model == "pinhole-radtan" || model == "pinhole-fov") {
    return "try pinhole-equi or ds-none";
  }
  if (model == "pinhole-equi") {
    return "try omni-radtan, and look for blur at the edge";
  }
  if (model == "omni-radtan") {
    return "try pinhole-equi, and look for blur at the edge";
  }
  if (model == "ds-none") {
    return "try pinhole-equi or omni-radtan";
  }
  return "try ds-none, pinhole-equi or omni-radtan";
}

}  // namespace tartan_calib::pipeline
