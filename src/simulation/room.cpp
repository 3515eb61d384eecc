#include "room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

namespace tartan_calib::simulation {
namespace {

constexpr int kPanoramaWidth = 3072;  ///< 490 pixels a radian, as fine as the lenses that look at it
constexpr int kPanoramaHeight = kPanoramaWidth / 2;
constexpr double kTexelsPerMetre = 160.0;

/// Half-sizes of the room and the rig's height above its floor, in the rig's axes (y down) [m].
const Eigen::Vector3d kRoomLow(-3.2, -1.7, -4.0);
const Eigen::Vector3d kRoomHigh(3.2, 1.1, 3.4);

int texels(double length_m) { return static_cast<int>(std::lround(length_m * kTexelsPerMetre)); }

/// Speckle and slow changes of brightness, as plaster and concrete have them.
cv::Mat roughSurface(cv::Size size, double grey, double speckle_grey, cv::RNG& rng) {
  cv::Mat1f fine(size);
  rng.fill(fine, cv::RNG::NORMAL, 0.0, speckle_grey);
  cv::GaussianBlur(fine, fine, cv::Size(), 0.8);
  cv::Mat1f coarse(cv::Size(6, 4));
  rng.fill(coarse, cv::RNG::UNIFORM, -0.12 * grey, 0.12 * grey);
  cv::Mat1f shading;
  cv::resize(coarse, shading, size, 0.0, 0.0, cv::INTER_CUBIC);
  const cv::Mat sum = fine + shading + grey;
  cv::Mat surface;
  sum.convertTo(surface, CV_8U);
  return surface;
}

cv::Rect randomPanel(const cv::Mat& wall, const cv::Size2d& size_m, double left_m, cv::RNG& rng) {
  const cv::Size size(texels(size_m.width), texels(size_m.height));
  const int top = texels(rng.uniform(0.35, 0.8));
  return cv::Rect(cv::Point(texels(left_m), top), size) & cv::Rect(cv::Point(), wall.size());
}

void paintPoster(cv::Mat wall, cv::RNG& rng) {
  wall.setTo(rng.uniform(150, 200));
  const int line_height = texels(0.035);
  cv::rectangle(wall, cv::Rect(0, 0, wall.cols, 3 * line_height), rng.uniform(40, 110), cv::FILLED);
  for (int y = 4 * line_height; y < wall.rows - line_height; y += line_height) {
    std::string text;
    for (int i = 0; i < 40; ++i) {
      text += rng.uniform(0, 6) == 0 ? ' ' : static_cast<char>('a' + rng.uniform(0, 26));
    }
    cv::putText(wall, text, cv::Point(4, y), cv::FONT_HERSHEY_SIMPLEX, 0.16, rng.uniform(40, 90), 1, cv::LINE_AA);
  }
  const cv::Rect picture(wall.cols / 2, wall.rows / 3, wall.cols / 2 - 6, wall.rows / 3);
  wall(picture).setTo(rng.uniform(60, 130));
  cv::circle(wall, (picture.tl() + picture.br()) / 2, picture.height / 3, rng.uniform(150, 220), cv::FILLED, cv::LINE_AA);
}

void paintCheckerboard(cv::Mat wall) {
  const int square = texels(0.09);
  wall.setTo(185);
  for (int y = square / 2; y + square <= wall.rows; y += square) {
    for (int x = square / 2; x + square <= wall.cols; x += square) {
      if ((x / square + y / square) % 2 == 0) {
        cv::rectangle(wall, cv::Rect(x, y, square, square), 30, cv::FILLED);
      }
    }
  }
}

void paintWindow(cv::Mat wall) {
  wall.setTo(228);
  const int frame = texels(0.05);
  cv::rectangle(wall, cv::Rect(cv::Point(), wall.size()), 70, 2 * frame);
  cv::line(wall, {wall.cols / 2, 0}, {wall.cols / 2, wall.rows}, 70, frame);
  cv::line(wall, {0, wall.rows / 3}, {wall.cols, wall.rows / 3}, 70, frame);
}

void paintDoor(cv::Mat wall) {
  wall.setTo(62);
  cv::rectangle(wall, cv::Rect(cv::Point(), wall.size()), 35, texels(0.05));
  cv::circle(wall, {wall.cols - texels(0.15), wall.rows / 2}, texels(0.04), 160, cv::FILLED, cv::LINE_AA);
}

cv::Mat paintWall(cv::Size size, int index, cv::RNG& rng) {
  cv::Mat wall = roughSurface(size, rng.uniform(88.0, 125.0), 3.0, rng);
  cv::line(wall, {0, size.height - texels(0.08)}, {size.width, size.height - texels(0.08)}, 50, texels(0.02));
  const double width_m = size.width / kTexelsPerMetre;
  for (double left_m = 0.3; left_m + 1.2 < width_m; left_m += rng.uniform(1.3, 1.9)) {
    const int kind = rng.uniform(0, 5);
    const bool is_first = left_m < 0.5;
    if (is_first && index == 0) {
      paintCheckerboard(wall(randomPanel(wall, {0.8, 0.7}, left_m, rng)));
    } else if (kind <= 1) {
      paintPoster(wall(randomPanel(wall, {0.8, 1.1}, left_m, rng)), rng);
    } else if (kind == 2) {
      paintWindow(wall(randomPanel(wall, {1.1, 1.2}, left_m, rng)));
    } else if (kind == 3) {
      const cv::Rect door(texels(left_m), size.height - texels(2.05), texels(0.95), texels(2.05));
      paintDoor(wall(door));
    }
  }
  return wall;
}

cv::Mat paintFloor(cv::Size size, cv::RNG& rng) {
  cv::Mat floor = roughSurface(size, 70.0, 9.0, rng);
  for (int i = 0; i < 14; ++i) {
    const cv::Point at(rng.uniform(0, size.width), rng.uniform(0, size.height));
    const cv::Point arm(rng.uniform(-texels(0.12), texels(0.12)), rng.uniform(-texels(0.12), texels(0.12)));
    cv::line(floor, at - arm, at + arm, 25, texels(0.03), cv::LINE_AA);
    cv::line(floor, at - cv::Point(-arm.y, arm.x), at + cv::Point(-arm.y, arm.x), 25, texels(0.03), cv::LINE_AA);
  }
  return floor;
}

cv::Mat paintCeiling(cv::Size size, cv::RNG& rng) {
  cv::Mat ceiling = roughSurface(size, 80.0, 2.0, rng);
  for (double y_m = 0.8; y_m + 0.4 < size.height / kTexelsPerMetre; y_m += 1.9) {
    for (double x_m = 0.7; x_m + 1.3 < size.width / kTexelsPerMetre; x_m += 2.3) {
      cv::rectangle(ceiling, cv::Rect(texels(x_m), texels(y_m), texels(1.25), texels(0.22)), 255, cv::FILLED);
    }
    const int pipe = texels(y_m + 0.9);
    cv::line(ceiling, {0, pipe}, {size.width, pipe}, 45, texels(0.06));
  }
  return ceiling;
}

/// Two faces for each axis, low then high.
using Faces = std::array<cv::Mat, 6>;

/// The two axes that span the faces across `axis`; the second is the vertical on walls.
std::array<int, 2> faceAxes(int axis) {
  return axis == 0 ? std::array<int, 2>{2, 1} : std::array<int, 2>{0, axis == 1 ? 2 : 1};
}

Faces paintFaces(std::uint64_t seed) {
  cv::RNG rng(seed);
  Faces faces;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [a, b] = faceAxes(axis);
    const cv::Size size(texels(kRoomHigh(a) - kRoomLow(a)), texels(kRoomHigh(b) - kRoomLow(b)));
    for (int side = 0; side < 2; ++side) {
      const int index = 2 * axis + side;
      cv::Mat& face = faces.at(static_cast<std::size_t>(index));
      if (axis == 1) {
        face = side == 0 ? paintCeiling(size, rng) : paintFloor(size, rng);
      } else {
        face = paintWall(size, index, rng);
      }
    }
  }
  return faces;
}

unsigned char lookAt(const Faces& faces, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d wall = (ray.array() > 0.0).select(kRoomHigh, kRoomLow);
  int axis = 0;
  const double distance = wall.cwiseQuotient(ray).minCoeff(&axis);
  const Eigen::Vector3d at = (distance * ray - kRoomLow) * kTexelsPerMetre;
  const cv::Mat& face = faces.at(static_cast<std::size_t>(2 * axis + (ray(axis) > 0.0 ? 1 : 0)));
  const auto [a, b] = faceAxes(axis);
  const int col = std::clamp(static_cast<int>(at(a)), 0, face.cols - 1);
  const int row = std::clamp(static_cast<int>(at(b)), 0, face.rows - 1);
  return face.at<unsigned char>(row, col);
}

}  // namespace

Room::Room(std::uint64_t seed) {
  const Faces faces = paintFaces(seed);
  cv::Mat once(kPanoramaHeight, kPanoramaWidth, CV_8UC1);
  for (int row = 0; row < kPanoramaHeight; ++row) {
    const double latitude = M_PI * ((row + 0.5) / kPanoramaHeight - 0.5);
    for (int col = 0; col < kPanoramaWidth; ++col) {
      const double longitude = 2.0 * M_PI * (col + 0.5) / kPanoramaWidth;
      const Eigen::Vector3d ray(std::cos(latitude) * std::sin(longitude), std::sin(latitude),
                                std::cos(latitude) * std::cos(longitude));
      once.at<unsigned char>(row, col) = lookAt(faces, ray);
    }
  }
  cv::GaussianBlur(once, once, cv::Size(), 0.7);
  cv::hconcat(once, once, panorama_);
}

cv::Mat2f Room::directions(const camera::Camera& camera, const geometry::Rigid3& T_cam_rig) {
  cv::Mat2f directions(camera.height, camera.width, cv::Vec2f(0.0F, 0.0F));
  const Eigen::Quaterniond R_rig_cam = T_cam_rig.rotation.conjugate();
  for (int row = 0; row < camera.height; ++row) {
    for (int col = 0; col < camera.width; ++col) {
      if (const auto ray_cam = camera::unproject(camera.model, {col, row})) {
        const Eigen::Vector3d ray = R_rig_cam * *ray_cam;
        const double turns = std::atan2(ray.x(), ray.z()) / (2.0 * M_PI);
        directions(row, col) =
            cv::Vec2f(static_cast<float>((turns < 0.0 ? turns + 1.0 : turns) * kPanoramaWidth - 0.5),
                      static_cast<float>((std::asin(std::clamp(ray.y(), -1.0, 1.0)) / M_PI + 0.5) * kPanoramaHeight - 0.5));
      }
    }
  }
  return directions;
}

cv::Mat1f Room::view(const cv::Mat2f& directions, double heading_rad) const {
  const double turns = heading_rad / (2.0 * M_PI);
  const int shift = static_cast<int>(std::floor((turns - std::floor(turns)) * kPanoramaWidth)) % kPanoramaWidth;
  // The view needs one turn and, between its last and first column, a neighbour to interpolate with.
  const cv::Mat turned = panorama_(cv::Rect(shift, 0, kPanoramaWidth, kPanoramaHeight));
  cv::Mat seen;
  cv::remap(turned, seen, directions, cv::Mat(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::Mat1f grey;
  seen.convertTo(grey, CV_32F);
  return grey;
}

}  // namespace tartan_calib::simulation
