#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>

#include "corners_header.h"
#include "read_file.h"
#include "tartan_calib/error.h"
#include "tartan_calib/io/corners_csv.h"

namespace tartan_calib::io {
namespace {

using observation::CameraView;
using observation::Corner;

constexpr std::size_t kNumFields = 9;

/// Goes through the text line by line and collects corners by camera and stamp.
class CornersReader {
 public:
  CornersReader(const std::string& text, const std::string& name) : text_(text), name_(name) {}

  std::vector<pipeline::CameraCorners> read() {
    while (nextLine()) {
      if (line_.empty()) {
        continue;
      }
      if (line_.front() == '#') {
        readComment();
      } else if (!has_header_) {
        readHeader();
      } else {
        readRow();
      }
    }
    if (!has_header_) {
      throw InputError(name_ + ": no header line; expected '" + std::string(kCornersHeader) + "'");
    }
    return sorted();
  }

 private:
  bool nextLine() {
    if (position_ >= text_.size()) {
      return false;
    }
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    line_ = std::string_view(text_).substr(position_, end - position_);
    if (!line_.empty() && line_.back() == '\r') {
      line_.remove_suffix(1);
    }
    position_ = end + 1;
    ++line_number_;
    return true;
  }

  void readComment() {
    const ParsedCameraLine parsed = parseCameraLine(line_);
    if (parsed.is_malformed) {
      reject("expected '# cam<index> <width> <height> <topic>'");
    }
    if (!parsed.camera) {
      return;
    }
    if (parsed.camera->index != static_cast<int>(cameras_.size())) {
      reject("expected the line of cam" + std::to_string(cameras_.size()) + ": cameras are listed once, in order");
    }
    pipeline::CameraCorners camera;
    camera.width = parsed.camera->width;
    camera.height = parsed.camera->height;
    camera.topic = parsed.camera->topic;
    cameras_.push_back(camera);
    images_.emplace_back();
  }

  void readHeader() {
    if (line_ != kCornersHeader) {
      reject("expected the header '" + std::string(kCornersHeader) + "'");
    }
    if (cameras_.empty()) {
      reject("expected lines '# cam<index> <width> <height> <topic>' before the header");
    }
    has_header_ = true;
  }

  void readRow() {
    splitFields();
    const int camera_index = field<int>(0, "camera");
    if (camera_index < 0 || static_cast<std::size_t>(camera_index) >= cameras_.size()) {
      reject("camera " + std::to_string(camera_index) + " has no '# cam' line");
    }
    const auto stamp_ns = field<std::int64_t>(1, "stamp_ns");
    Corner corner;
    corner.corner_id = field<int>(2, "corner_id");
    if (corner.corner_id < 0) {
      reject("corner_id must not be negative");
    }
    corner.px = {number(3, "u_px"), number(4, "v_px")};
    checkInside(corner, cameras_[static_cast<std::size_t>(camera_index)]);
    readCovariance(corner);
    readUsed(corner);
    images_[static_cast<std::size_t>(camera_index)][stamp_ns].push_back(corner);
  }

  void checkInside(const Corner& corner, const pipeline::CameraCorners& camera) const {
    constexpr double kSlack_px = 1.0;  // for other conventions of where pixel (0, 0) lies
    const Eigen::Array2d size(camera.width, camera.height);
    if ((corner.px.array() < -kSlack_px).any() || (corner.px.array() > size - 1.0 + kSlack_px).any()) {
      reject("the corner is not in the image of " + std::to_string(camera.width) + "x" + std::to_string(camera.height) +
             " pixels");
    }
  }

  void readCovariance(Corner& corner) const {
    if (fields_[5].empty() && fields_[6].empty() && fields_[7].empty()) {
      return;
    }
    const double uu = number(5, "cov_uu");
    const double uv = number(6, "cov_uv");
    const double vv = number(7, "cov_vv");
    if (uu <= 0.0 || vv <= 0.0 || uv * uv >= uu * vv) {
      reject("cov_uu, cov_uv, cov_vv are no covariance (positive definite)");
    }
    corner.cov_px2 << uu, uv, uv, vv;
  }

  void readUsed(Corner& corner) const {
    if (!fields_[8].empty() && fields_[8] != "0" && fields_[8] != "1") {
      reject("used must be 0 or 1, it is '" + std::string(fields_[8]) + "'");
    }
    corner.used = fields_[8] != "0";
  }

  void splitFields() {
    std::size_t count = 0;
    std::size_t begin = 0;
    while (begin <= line_.size()) {
      const std::size_t end = std::min(line_.find(',', begin), line_.size());
      if (count < kNumFields) {
        fields_[count] = line_.substr(begin, end - begin);
      }
      ++count;
      begin = end + 1;
    }
    if (count != kNumFields) {
      reject("expected " + std::to_string(kNumFields) + " fields, found " + std::to_string(count));
    }
  }

  template <typename Int>
  Int field(std::size_t index, const char* meaning) const {
    Int value = 0;
    const char* end = fields_[index].data() + fields_[index].size();
    const auto [stop, error] = std::from_chars(fields_[index].data(), end, value);
    if (error != std::errc() || stop != end) {
      rejectField(index, meaning, "a whole number");
    }
    return value;
  }

  double number(std::size_t index, const char* meaning) const {
    // The field ends at a comma or a line's end inside of text_, where strtod stops by itself.
    const char* begin = fields_[index].data();
    char* stop = nullptr;
    const double value = std::strtod(begin, &stop);
    if (fields_[index].empty() || stop != begin + fields_[index].size() || !std::isfinite(value)) {
      rejectField(index, meaning, "a number");
    }
    return value;
  }

  std::vector<pipeline::CameraCorners> sorted() {
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      for (auto& [stamp_ns, corners] : images_[i]) {
        const auto by_id = [](const Corner& a, const Corner& b) { return a.corner_id < b.corner_id; };
        std::sort(corners.begin(), corners.end(), by_id);
        const auto same_id = [](const Corner& a, const Corner& b) { return a.corner_id == b.corner_id; };
        const auto twice = std::adjacent_find(corners.begin(), corners.end(), same_id);
        if (twice != corners.end()) {
          throw InputError(name_ + ": corner " + std::to_string(twice->corner_id) + " of cam" + std::to_string(i) +
                           " is there twice at stamp " + std::to_string(stamp_ns));
        }
        cameras_[i].images.push_back(CameraView{static_cast<int>(i), stamp_ns, std::move(corners)});
      }
      cameras_[i].num_images = cameras_[i].images.size();
    }
    return std::move(cameras_);
  }

  [[noreturn]] void reject(const std::string& reason) const {
    throw InputError(name_ + ":" + std::to_string(line_number_) + ": " + reason);
  }

  [[noreturn]] void rejectField(std::size_t index, const char* meaning, const char* expected) const {
    reject(std::string(meaning) + " must be " + expected + ", it is '" + std::string(fields_[index]) + "'");
  }

  const std::string& text_;
  const std::string& name_;
  std::size_t position_ = 0;
  int line_number_ = 0;
  std::string_view line_;
  std::array<std::string_view, kNumFields> fields_;
  bool has_header_ = false;
  std::vector<pipeline::CameraCorners> cameras_;
  std::vector<std::map<std::int64_t, std::vector<Corner>>> images_;  ///< by camera and stamp
};

}  // namespace

std::vector<pipeline::CameraCorners> parseCorners(const std::string& text, const std::string& name) {
  return CornersReader(text, name).read();
}

std::vector<pipeline::CameraCorners> loadCorners(const std::string& path) { return parseCorners(readFile(path), path); }

}  // namespace tartan_calib::io
