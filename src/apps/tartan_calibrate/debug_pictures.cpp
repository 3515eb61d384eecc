#include "tartan_calibrate/debug_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tartan_calib/error.h"
#include "tartan_calib/io/atomic_file.h"
#include "tartan_calib/pipeline/virtual_view.h"
#include "tartan_calib/text.h"
#include "tartan_calibrate/point_cloud_picture.h"

namespace tartan_calib::apps {
namespace {

namespace fs = std::filesystem;
using observation::CameraView;
using observation::Corner;
using Pinholes = std::vector<pipeline::VirtualPinhole>;

const cv::Scalar kDetected(0.0, 0.0, 255.0);
const cv::Scalar kFoundLater(0.0, 255.0, 0.0);
const cv::Scalar kPredicted(0.0, 220.0, 255.0);
const cv::Scalar kId(255.0, 128.0, 0.0);
constexpr int kCrossFace_px = 500;  ///< side of a face in the picture of the cube

cv::Point2f pointOf(const Eigen::Vector2d& px) { return {static_cast<float>(px.x()), static_cast<float>(px.y())}; }

const cv::Scalar& colourOf(const Corner& corner) { return corner.round == 0 ? kDetected : kFoundLater; }

cv::Mat colourImage(const cv::Mat& gray) {
  cv::Mat colour;
  cv::cvtColor(gray, colour, cv::COLOR_GRAY2BGR);
  return colour;
}

/// Seconds with six decimals, as TartanCalib has them in its names.
std::string stampText(std::int64_t stamp_ns) {
  constexpr double kSecondsPerNs = 1e-9;
  return std::to_string(static_cast<double>(stamp_ns) * kSecondsPerNs);
}

void savePng(const fs::path& path, const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", picture, bytes);
  io::writeFile(path.string(), std::string(bytes.begin(), bytes.end()));
}

/// The pictures of one camera.
class CameraPictures {
 public:
  CameraPictures(const Inputs& inputs, const pipeline::CalibrationResult& result, std::size_t camera_index, fs::path folder)
      : inputs_(inputs),
        camera_index_(camera_index),
        camera_(result.solution.rig.cameras[camera_index].camera),
        corners_(pipeline::observedCorners(result)[camera_index]),
        target_points_(calibration::warpedPoints(target::cornerPoints(result.target), result.solution.board_warp_m)),
        folder_(std::move(folder)) {
    const calibration::Solution& solution = result.solution;
    for (std::size_t i = 0; i < solution.views.size(); ++i) {
      for (const CameraView& image : solution.views[i].cameras) {
        if (static_cast<std::size_t>(image.camera_index) == camera_index) {
          T_cam_target_[image.stamp_ns] = solution.rig.cameras[camera_index].T_cam_rig * solution.T_rig_target[i];
        }
      }
    }
    const pipeline::Projections& projections = inputs.options.projections;
    pinholes_ = projections.pinholes;
    if (projections.empty()) {
      const auto cube = pipeline::cubeViews({});
      pinholes_.assign(cube.begin(), cube.end());
    }
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) {
      throw InputError("folder " + folder_.string() + " for the pictures cannot be made: " + error.message());
    }
  }

  void write(const std::vector<std::string>& modes, const ProgressCall& progress) const {
    const auto has = [&modes](const char* mode) { return std::find(modes.begin(), modes.end(), mode) != modes.end(); };
    if (has("reprojectionpoints")) {
      writeAllPoints();
    }
    if (has("targetpointcloud")) {
      writeTargetCloud();
    }
    if (has("pointcloudprojection")) {
      writeViewCloud();
    }
    if (has("originalprojection") || has("pinholeprojection") || has("individualprojections")) {
      writeImages(has("originalprojection"), has("pinholeprojection"), has("individualprojections"), progress);
    }
  }

 private:
  void writeImages(bool original, bool cross, bool individual, const ProgressCall& progress) const {
    const std::vector<pipeline::VirtualView> views = viewsOf(individual ? pinholes_ : Pinholes());
    const std::vector<pipeline::VirtualView> faces = viewsOf(cross ? crossFaces() : Pinholes());
    const pipeline::ImageSource next_image = inputs_.streams[camera_index_].open();
    std::size_t done = 0;
    while (const auto image = next_image()) {
      progress(done++, inputs_.streams[camera_index_].num_images);
      const CameraView* seen = seenIn(image->stamp_ns);
      const cv::Mat gray = seen == nullptr ? cv::Mat() : loaded(*image);
      if (gray.cols != camera_.width || gray.rows != camera_.height) {
        continue;
      }
      const std::string name = "frame_" + stampText(image->stamp_ns);
      if (original) {
        savePng(folder_ / (name + "_original.png"), drawOriginal(gray, *seen));
      }
      if (cross) {
        savePng(folder_ / (name + "_pinhole.png"), drawCross(faces, gray, *seen));
      }
      for (std::size_t i = 0; i < views.size(); ++i) {
        savePng(folder_ / (name + "_projection_" + std::to_string(i) + ".png"), drawView(views[i], gray, *seen));
      }
      if (individual && inputs_.options.projections.rectified) {
        writeRectified(gray, *seen);
      }
    }
  }

  static Pinholes crossFaces() {
    pipeline::ViewSize size;
    size.width = size.height = kCrossFace_px;
    const auto cube = pipeline::cubeViews(size);
    return {cube.begin(), cube.end()};
  }

  std::vector<pipeline::VirtualView> viewsOf(const Pinholes& pinholes) const {
    std::vector<pipeline::VirtualView> views;
    views.reserve(pinholes.size());
    for (const pipeline::VirtualPinhole& pinhole : pinholes) {
      views.emplace_back(camera_, pinhole);
    }
    return views;
  }

  /// What the camera saw at a time; null where it saw nothing.
  const CameraView* seenIn(std::int64_t stamp_ns) const {
    const auto found = std::find_if(corners_.images.begin(), corners_.images.end(),
                                    [stamp_ns](const CameraView& image) { return image.stamp_ns == stamp_ns; });
    return found == corners_.images.end() ? nullptr : &*found;
  }

  /// Empty where the image cannot be decoded, which the calibration has told already.
  static cv::Mat loaded(const pipeline::StampedImage& image) {
    try {
      return image.load();
    } catch (const InputError&) {
      return {};
    }
  }

  cv::Mat drawOriginal(const cv::Mat& gray, const CameraView& seen) const {
    cv::Mat picture = colourImage(gray);
    const auto pose = T_cam_target_.find(seen.stamp_ns);
    for (const Eigen::Vector3d& point : target_points_) {
      const auto px = pose == T_cam_target_.end() ? std::nullopt : camera::project(camera_, pose->second * point);
      if (px && camera::isInside(camera_, *px)) {
        cv::drawMarker(picture, pointOf(*px), kPredicted, cv::MARKER_CROSS, 5, 1);
      }
    }
    for (const Corner& corner : seen.corners) {
      cv::circle(picture, pointOf(corner.px), 5, colourOf(corner), 1, cv::LINE_AA);
    }
    return picture;
  }

  /// A virtual view with the corners that are in it.
  cv::Mat drawView(const pipeline::VirtualView& view, const cv::Mat& gray, const CameraView& seen) const {
    cv::Mat picture = colourImage(view.remap(gray));
    const cv::Rect2f frame(0.0F, 0.0F, static_cast<float>(picture.cols), static_cast<float>(picture.rows));
    for (const Corner& corner : seen.corners) {
      const auto px = view.toView(corner.px);
      if (px && frame.contains(pointOf(*px))) {
        cv::circle(picture, pointOf(*px), 5, colourOf(corner), 2, cv::LINE_AA);
        cv::putText(picture, std::to_string(corner.corner_id), pointOf(*px), cv::FONT_HERSHEY_PLAIN, 0.8, kId);
      }
    }
    return picture;
  }

  /// The faces of a cube, unfolded around the one ahead.
  cv::Mat drawCross(const std::vector<pipeline::VirtualView>& faces, const cv::Mat& gray, const CameraView& seen) const {
    struct Place {
      int col;
      int row;
      int turn;  ///< cv::RotateFlags, or -1
    };
    constexpr std::array<Place, 5> kPlaces = {{{1, 0, -1},
                                               {2, 1, cv::ROTATE_90_CLOCKWISE},
                                               {1, 2, cv::ROTATE_180},
                                               {0, 1, cv::ROTATE_90_COUNTERCLOCKWISE},
                                               {1, 1, -1}}};
    cv::Mat picture = cv::Mat::zeros(3 * kCrossFace_px, 3 * kCrossFace_px, CV_8UC3);
    for (std::size_t i = 0; i < faces.size(); ++i) {
      cv::Mat face = drawView(faces[i], gray, seen);
      if (kPlaces[i].turn >= 0) {
        cv::rotate(face, face, kPlaces[i].turn);
      }
      face.copyTo(picture(cv::Rect(kPlaces[i].col * kCrossFace_px, kPlaces[i].row * kCrossFace_px, face.cols, face.rows)));
    }
    return picture;
  }

  void writeRectified(const cv::Mat& gray, const CameraView& seen) const {
    const auto pose = T_cam_target_.find(seen.stamp_ns);
    const pipeline::ViewSize& size = *inputs_.options.projections.rectified;
    const auto pinhole = pose == T_cam_target_.end()
                             ? std::nullopt
                             : pipeline::rectifiedView(pose->second, target_points_, size.width, size.height);
    if (pinhole) {
      savePng(folder_ / ("homography_" + stampText(seen.stamp_ns) + ".png"),
              drawView(pipeline::VirtualView(camera_, *pinhole), gray, seen));
    }
  }

  void writeAllPoints() const {
    cv::Mat picture(camera_.height, camera_.width, CV_8UC3, cv::Scalar::all(255.0));
    for (const CameraView& image : corners_.images) {
      for (const Corner& corner : image.corners) {
        cv::circle(picture, pointOf(corner.px), 1, colourOf(corner), cv::FILLED, cv::LINE_AA);
      }
    }
    savePng(folder_ / "all_points.png", picture);
  }

  void writeTargetCloud() const {
    std::vector<CloudPoint> points;
    std::size_t index = 0;
    for (const auto& [stamp_ns, T_cam_target] : T_cam_target_) {
      const cv::Scalar colour = sequenceColour(index++, T_cam_target_.size());
      for (const Eigen::Vector3d& point : target_points_) {
        points.push_back({T_cam_target * point, colour});
      }
    }
    savePng(folder_ / "target_point_cloud.png", drawPointCloud(points, "m"));
  }

  /// Where a grid of pixels of every virtual view looks, on the plane z = 1 of that view; only what the image shows.
  void writeViewCloud() const {
    constexpr int kGridCells = 30;
    std::vector<CloudPoint> points;
    for (std::size_t i = 0; i < pinholes_.size(); ++i) {
      const pipeline::VirtualPinhole& pinhole = pinholes_[i];
      for (int k = 0; k < (kGridCells + 1) * (kGridCells + 1); ++k) {
        const Eigen::Vector2d share(k % (kGridCells + 1), k / (kGridCells + 1));
        const Eigen::Vector2d px = share.cwiseProduct(Eigen::Vector2d(pinhole.width - 1, pinhole.height - 1)) / kGridCells;
        const Eigen::Vector2d m = (px - pinhole.centre_px).cwiseQuotient(pinhole.focal_px);
        const Eigen::Vector3d p_cam = pinhole.R_cam_view * m.homogeneous();
        const auto image_px = camera::project(camera_.model, p_cam);
        if (image_px && camera::isInside(camera_, *image_px)) {
          points.push_back({p_cam, sequenceColour(i, pinholes_.size())});
        }
      }
    }
    savePng(folder_ / "view_point_cloud.png", drawPointCloud(points, "of the views' distance"));
  }

  const Inputs& inputs_;
  std::size_t camera_index_;
  camera::Camera camera_;
  pipeline::CameraCorners corners_;
  std::vector<Eigen::Vector3d> target_points_;
  fs::path folder_;
  std::map<std::int64_t, geometry::Rigid3> T_cam_target_;
  Pinholes pinholes_;
};

}  // namespace

void writeDebugPictures(const Inputs& inputs, const pipeline::CalibrationResult& result,
                        const std::vector<std::string>& modes, const std::string& folder, const ProgressCall& progress) {
  for (std::size_t i = 0; i < result.cameras.size(); ++i) {
    const fs::path own = result.cameras.size() > 1 ? fs::path(folder) / cameraName(i) : fs::path(folder);
    CameraPictures(inputs, result, i, own).write(modes, progress);
  }
}

}  // namespace tartan_calib::apps
