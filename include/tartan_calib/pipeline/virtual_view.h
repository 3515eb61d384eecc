#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::pipeline {

/// A pinhole camera in the place of a real one. Pixel (u, v) looks along R_cam_view * ((u - cu) / fu, (v - cv) / fv, 1).
struct VirtualPinhole {
  Eigen::Matrix3d R_cam_view = Eigen::Matrix3d::Identity();
  Eigen::Vector2d focal_px = Eigen::Vector2d::Ones();
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  ///< cu, cv
  int width = 0;
  int height = 0;
};

/// Size of a virtual view: angles between the centres of its outermost pixels, as TartanCalib counts them.
struct ViewSize {
  double fov_x_rad = 1.5707963267948966;
  double fov_y_rad = 1.5707963267948966;
  int width = 1000;
  int height = 1000;
};

/// The view along Rz(about_z_rad) * Rx(about_x_rad) * z. TartanCalib's default, 90 and 0 degrees, looks along -y.
VirtualPinhole pinholeView(const ViewSize& size, double about_x_rad, double about_z_rad);

/// The faces of a cube but one: at polar angle 90 degrees towards -y, x, y and -x, then along z. The lower edges of the
/// first four adjoin the last.
std::array<VirtualPinhole, 5> cubeViews(const ViewSize& size);

/// The view in which the board's plane is parallel to the image, x to the right and y up, and the board fills the middle of
/// it as in TartanCalib: from 20 to 80 % where the board and the view have the same shape. Empty where the board is not seen
/// from its front.
std::optional<VirtualPinhole> rectifiedView(const geometry::Rigid3& T_cam_target,
                                            const std::vector<Eigen::Vector3d>& target_points, int width, int height);

/// What detection looks at besides the images themselves. Empty: nothing.
struct Projections {
  std::vector<VirtualPinhole> pinholes;  ///< of every image
  std::optional<ViewSize> rectified;     ///< rectified on the predicted board; its angles do not matter

  bool empty() const { return pinholes.empty() && !rectified; }
};

/// A virtual pinhole in the place of a calibrated camera, with the table of where each of its pixels comes from. Const after
/// construction: one serves all images and threads.
class VirtualView {
 public:
  VirtualView(const camera::Camera& camera, const VirtualPinhole& pinhole);

  /// What the pinhole sees of an image of the camera (CV_8UC1), bilinear; 0 where the image holds nothing.
  cv::Mat remap(const cv::Mat& gray) const;

  /// Pixel of the view to pixel of the camera, which may lie outside of its image; empty where the model has none.
  std::optional<Eigen::Vector2d> toImage(const Eigen::Vector2d& view_px) const;

  /// The reverse; empty behind the pinhole and where the model has no ray.
  std::optional<Eigen::Vector2d> toView(const Eigen::Vector2d& image_px) const;

 private:
  camera::Camera camera_;
  VirtualPinhole pinhole_;
  cv::Mat position_;  ///< cv::convertMaps: whole pixels, CV_16SC2
  cv::Mat fraction_;  ///< and index of the interpolation weights, CV_16UC1
};

}  // namespace tartan_calib::pipeline
