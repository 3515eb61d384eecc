#include "detect_corners/corner_pictures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "common/picture_file.h"
#include "tartan_calib/error.h"

namespace tartan_calib::apps {
namespace {

namespace fs = std::filesystem;

/// Colours that colour-blind people tell apart (Okabe and Ito), as BGR.
const cv::Scalar kRing(0, 159, 230);
const cv::Scalar kNumber(233, 180, 86);
const cv::Scalar kEdge(0, 0, 0);

/// OpenCV draws at fractions of a pixel given in fixed point with so many bits.
constexpr int kFractionBits = 4;
constexpr double kFraction = 1 << kFractionBits;
constexpr int kRingRadius_px = 5;

/// For numbers and lines that are seen in a large image too.
double drawingScale(const cv::Mat& image) {
  constexpr double kUsualWidth_px = 1200.0;
  return std::max(1.0, image.cols / kUsualWidth_px);
}

void drawRing(cv::Mat& picture, const Eigen::Vector2d& px, double scale) {
  const cv::Point centre(static_cast<int>(std::lround(px.x() * kFraction)),
                         static_cast<int>(std::lround(px.y() * kFraction)));
  const int radius = static_cast<int>(scale * kRingRadius_px * kFraction);
  const int width = static_cast<int>(std::lround(scale));
  cv::circle(picture, centre, radius, kEdge, 3 * width, cv::LINE_AA, kFractionBits);
  cv::circle(picture, centre, radius, kRing, width, cv::LINE_AA, kFractionBits);
}

/// In the middle of a tag's corners that were seen.
void drawTagNumber(cv::Mat& picture, const std::vector<Eigen::Vector2d>& corners, int id, double scale) {
  constexpr double kTextSize = 0.45;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& px : corners) {
    middle += px / static_cast<double>(corners.size());
  }
  const std::string text = std::to_string(id);
  const int width = static_cast<int>(std::lround(scale));
  const cv::Size extent = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale * kTextSize, width, nullptr);
  const cv::Point where(static_cast<int>(middle.x()) - extent.width / 2, static_cast<int>(middle.y()) + extent.height / 2);
  cv::putText(picture, text, where, cv::FONT_HERSHEY_SIMPLEX, scale * kTextSize, kEdge, 3 * width, cv::LINE_AA);
  cv::putText(picture, text, where, cv::FONT_HERSHEY_SIMPLEX, scale * kTextSize, kNumber, width, cv::LINE_AA);
}

void drawTagNumbers(cv::Mat& picture, const std::map<int, Eigen::Vector2d>& seen, const target::AprilGrid& grid,
                    double scale) {
  constexpr std::size_t kMinCorners = 2;  // that say where the tag is
  for (int tag = 0; tag < target::numTags(grid); ++tag) {
    std::vector<Eigen::Vector2d> corners;
    for (const int id : target::tagCornerIds(grid, tag)) {
      if (const auto found = seen.find(id); found != seen.end()) {
        corners.push_back(found->second);
      }
    }
    if (corners.size() >= kMinCorners) {
      drawTagNumber(picture, corners, grid.code_offset + tag, scale);
    }
  }
}

std::optional<cv::Mat> loaded(const pipeline::StampedImage& image) {
  try {
    return image.load();
  } catch (const InputError&) {  // counted by the detection, which met it before
    return std::nullopt;
  }
}

}  // namespace

cv::Mat drawCorners(const cv::Mat& gray, const std::vector<observation::Corner>& corners, const target::Target& target) {
  cv::Mat picture;
  cv::cvtColor(gray, picture, cv::COLOR_GRAY2BGR);
  const double scale = drawingScale(picture);
  std::map<int, Eigen::Vector2d> seen;
  for (const observation::Corner& corner : corners) {
    seen[corner.corner_id] = corner.px;
    drawRing(picture, corner.px, scale);
  }
  if (const auto* grid = std::get_if<target::AprilGrid>(&target)) {
    drawTagNumbers(picture, seen, *grid, scale);
  }
  return picture;
}

std::vector<std::size_t> evenlyChosen(std::size_t total, std::size_t count) {
  std::vector<std::size_t> chosen;
  const std::size_t num_chosen = std::min(total, count);
  for (std::size_t i = 0; i < num_chosen; ++i) {
    chosen.push_back(i * total / num_chosen);
  }
  return chosen;
}

std::size_t writeCornerPictures(const pipeline::CameraStream& stream, const std::vector<observation::CameraView>& images,
                                const target::Target& target, const std::string& folder, std::size_t max_pictures,
                                const ProgressCall& progress) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw InputError("cannot make the folder " + folder + " (" + error.message() + ")");
  }
  const std::vector<std::size_t> chosen = evenlyChosen(stream.num_images, max_pictures);
  const pipeline::ImageSource next_image = stream.open();
  std::size_t num_drawn = 0;
  std::size_t done = 0;
  progress(done, chosen.size());
  for (std::size_t index = 0; done < chosen.size(); ++index) {
    const std::optional<pipeline::StampedImage> image = next_image();
    if (!image) {
      break;
    }
    if (index != chosen[done]) {
      continue;
    }
    if (const std::optional<cv::Mat> gray = loaded(*image)) {
      const auto seen = std::find_if(images.begin(), images.end(),
                                     [&](const observation::CameraView& view) { return view.stamp_ns == image->stamp_ns; });
      const auto corners = seen == images.end() ? std::vector<observation::Corner>() : seen->corners;
      savePng((fs::path(folder) / (std::to_string(image->stamp_ns) + ".png")).string(), drawCorners(*gray, corners, target));
      ++num_drawn;
    }
    progress(++done, chosen.size());
  }
  return num_drawn;
}

}  // namespace tartan_calib::apps
