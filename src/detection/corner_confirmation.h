#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "corner_candidate.h"
#include "tag_payload.h"
#include "tartan_calib/detection/board_map.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::detection {

/// Drops the corners of an AprilGrid that nothing but their own looks speaks for: those that are flat against the others,
/// those on tags whose payload is another's, and those on tags whose payload cannot be told, unless they look perfect and
/// corners on tags whose payload is in the image vouch for them.
void dropUnconfirmed(const cv::Mat& gray, const BoardMap& map, const target::AprilGrid& grid, const TagPayload& payload,
                     std::vector<CornerCandidate>& candidates);

}  // namespace tartan_calib::detection
