#pragma once

#include <string>

namespace tartan_calib::pipeline {

/// What to try for a lens that the model of this name cannot follow, such as "try pinhole-radtan".
std::string richerModels(const std::string& model);

}  // namespace tartan_calib::pipeline
