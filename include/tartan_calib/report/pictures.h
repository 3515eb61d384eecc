#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tartan_calib/pipeline/calibrate.h"
#include "tartan_calib/report/listener.h"
#include "tartan_calib/report/seen_corners.h"

namespace tartan_calib::report {

/// A part of an image in a JPEG file: its pixel (x, y) shows the image's pixel (origin + ((x, y) + 0.5) / scale - 0.5).
struct Picture {
  int view = 0;      ///< index in Solution::views
  std::string file;  ///< name in the folder
  Eigen::Vector2i origin_px = Eigen::Vector2i::Zero();
  double scale = 1.0;
};

struct CameraPictures {
  std::vector<Picture> frames;  ///< small, by view; evenly chosen where there are too many
  std::vector<Picture> worst;   ///< the board in the views with the largest residuals, worst first
  cv::Mat brightest;            ///< CV_8UC1, every pixel's brightest value over the frames, at their scale
};

struct PictureOptions {
  int max_frames = 480;  ///< of all cameras together
  int num_worst = 5;     ///< per camera
  int num_threads = 0;   ///< 0: all cores
  Listener listener;     ///< told of the images
};

/// Goes through the images once more and writes pictures of the solution's views into the folder. Images that cannot be
/// decoded are left out. `corners`: seenCorners(result). Empty vectors where there are no streams.
std::vector<CameraPictures> takePictures(const std::vector<pipeline::CameraStream>& streams,
                                         const pipeline::CalibrationResult& result, const std::vector<SeenCorners>& corners,
                                         const std::string& folder, const PictureOptions& options);

}  // namespace tartan_calib::report
