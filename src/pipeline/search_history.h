#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/detection/board_map.h"

namespace tartan_calib::pipeline {

/// Where an image's corners were predicted when they were last looked for, and whether they were all found.
struct SearchedImage {
  detection::BoardMap map;
  bool is_complete = false;
};

/// Of one camera, by stamp.
using SearchHistory = std::map<std::int64_t, SearchedImage>;

/// Points of the board that the image shows.
int countPredicted(const camera::Camera& camera, const detection::BoardMap& map,
                   const std::vector<Eigen::Vector3d>& target_points);

/// Whether to look again: the predictions have moved so far that something else may be found.
bool hasMoved(const SearchedImage& before, const camera::Camera& camera, const detection::BoardMap& map,
              const std::vector<Eigen::Vector3d>& target_points);

}  // namespace tartan_calib::pipeline
