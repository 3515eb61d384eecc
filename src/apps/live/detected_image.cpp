#include "live/detected_image.h"

#include <future>

namespace tartan_calib::apps {
namespace {

DetectedImage detectImage(const detection::TargetDetector& detector, const ArrivedImage& image) {
  DetectedImage detected;
  detected.camera_index = image.camera_index;
  detected.stamp_ns = image.stamp_ns;
  try {
    const cv::Mat gray = image.decode();
    detected.corners = detector.detect(gray).corners;
    detected.gray = gray;
  } catch (const std::exception& error) {
    detected.unreadable_reason = error.what();
  }
  return detected;
}

}  // namespace

std::vector<DetectedImage> detectImages(const detection::TargetDetector& detector, const std::vector<ArrivedImage>& images) {
  std::vector<std::future<DetectedImage>> running;
  running.reserve(images.size());
  for (const ArrivedImage& image : images) {
    running.push_back(std::async(std::launch::async, detectImage, std::cref(detector), std::cref(image)));
  }
  std::vector<DetectedImage> detected;
  detected.reserve(images.size());
  for (std::future<DetectedImage>& image : running) {
    detected.push_back(image.get());
  }
  return detected;
}

}  // namespace tartan_calib::apps
