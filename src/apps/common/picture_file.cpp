#include "common/picture_file.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "common/interrupt.h"
#include "tartan_calib/error.h"
#include "tartan_calib/io/atomic_file.h"

namespace tartan_calib::apps {

cv::Mat arrange(const std::vector<cv::Mat>& pictures) {
  constexpr std::size_t kColumns = 2;
  cv::Size cell;
  for (const cv::Mat& picture : pictures) {
    cell = {std::max(cell.width, picture.cols), std::max(cell.height, picture.rows)};
  }
  const int columns = static_cast<int>(std::min(kColumns, pictures.size()));
  const int rows = static_cast<int>((pictures.size() + kColumns - 1) / kColumns);
  cv::Mat sheet(rows * cell.height, columns * cell.width, CV_8UC3, cv::Scalar::all(255));
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const cv::Point corner(static_cast<int>(i % kColumns) * cell.width, static_cast<int>(i / kColumns) * cell.height);
    pictures[i].copyTo(sheet(cv::Rect(corner, pictures[i].size())));
  }
  return sheet;
}

void checkPngName(const std::string& path) {
  const std::string ending = path.size() < 4 ? "" : path.substr(path.size() - 4);
  if (ending != ".png" && ending != ".PNG") {
    throw InputError("the picture " + path + " must have a name that ends in .png");
  }
}

void savePng(const std::string& path, const cv::Mat& picture) {
  checkPngName(path);
  std::vector<uchar> bytes;
  cv::imencode(".png", picture, bytes);
  const UninterruptedSection file_is_written_whole;
  io::writeFile(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace tartan_calib::apps
