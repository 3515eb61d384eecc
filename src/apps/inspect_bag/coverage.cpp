#include <algorithm>
#include <array>

#include "inspect_bag/report.h"

namespace tartan_calib::apps {
namespace {

/// Cells over the image; a character is about twice as high as wide.
constexpr int kPictureCols = 32;
constexpr int kPictureRows = 12;
constexpr int kManyCorners = 10;

/// Counts of corners in rows x cols cells, row by row.
std::vector<int> cellCounts(const pipeline::CameraCorners& corners, int rows, int cols) {
  std::vector<int> counts(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols));
  const auto cell = [](double px, int size, int cells) {
    return std::clamp(static_cast<int>((px + 0.5) / size * cells), 0, cells - 1);
  };
  for (const observation::CameraView& image : corners.images) {
    for (const observation::Corner& corner : image.corners) {
      const int row = cell(corner.px.y(), corners.height, rows);
      ++counts[static_cast<std::size_t>(row * cols + cell(corner.px.x(), corners.width, cols))];
    }
  }
  return counts;
}

char sign(int count) {
  if (count == 0) {
    return '.';
  }
  return count < kManyCorners ? '+' : '#';
}

}  // namespace

std::vector<std::string> coveragePicture(const pipeline::CameraCorners& corners) {
  const std::vector<int> counts = cellCounts(corners, kPictureRows, kPictureCols);
  std::vector<std::string> picture;
  for (auto row = counts.begin(); row != counts.end(); row += kPictureCols) {
    picture.emplace_back();
    std::transform(row, row + kPictureCols, std::back_inserter(picture.back()), sign);
  }
  return picture;
}

std::vector<std::string> emptyThirds(const pipeline::CameraCorners& corners) {
  constexpr int kThirds = 3;
  constexpr std::array<const char*, 9> kNames = {"upper left",   "upper middle", "upper right",  "middle left", "centre",
                                                 "middle right", "lower left",   "lower middle", "lower right"};
  const std::vector<int> counts = cellCounts(corners, kThirds, kThirds);
  std::vector<std::string> empty;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (counts[i] == 0) {
      empty.emplace_back(kNames[i]);
    }
  }
  return empty;
}

}  // namespace tartan_calib::apps
