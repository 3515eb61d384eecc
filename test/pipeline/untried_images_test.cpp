#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "tartan_calib/pipeline/calibrate.h"
#include "tartan_calib/simulation/lens.h"
#include "tartan_calib/simulation/recording.h"
#include "tartan_calib/simulation/renderer.h"

/// Images that detection cannot use are tried in the rounds.
namespace tartan_calib::pipeline {
namespace {

constexpr std::size_t kNumFrames = 14;
constexpr std::size_t kTwoTagsFrame = 4;  ///< both cameras see two tags
constexpr std::size_t kThumbFrame = 9;    ///< cam1 sees one tag, with a thumb on its payload: nothing to decode
constexpr int kOnlyTag = 14;              ///< of 36: in the middle of the board
constexpr unsigned char kPaintGrey = 120;

void paint(const std::vector<Eigen::Vector2d>& outline_px, cv::Mat& image) {
  std::vector<cv::Point> points;
  for (const Eigen::Vector2d& px : outline_px) {
    points.emplace_back(static_cast<int>(std::lround(px.x())), static_cast<int>(std::lround(px.y())));
  }
  cv::fillConvexPoly(image, points, cv::Scalar(kPaintGrey));
}

/// Paints all tags but some, from kOnlyTag on.
void leaveTags(const simulation::RenderedView& view, int num_left, cv::Mat& image) {
  const target::AprilGrid grid;
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(grid);
  std::vector<Eigen::Vector2d> px(points.size(), Eigen::Vector2d::Constant(-100.0));
  for (const simulation::TrueCorner& corner : view.corners) {
    px[static_cast<std::size_t>(corner.corner_id)] = corner.px;
  }
  constexpr double kGrowth = 1.04;  // to the end of the blurred edge; the corner squares stay
  for (int tag = 0; tag < target::numTags(grid); ++tag) {
    std::vector<Eigen::Vector2d> outline;
    for (const int id : target::tagCornerIds(grid, tag)) {
      outline.push_back(px[static_cast<std::size_t>(id)]);
    }
    const Eigen::Vector2d centre = 0.25 * (outline[0] + outline[1] + outline[2] + outline[3]);
    for (Eigen::Vector2d& corner : outline) {
      corner = centre + kGrowth * (corner - centre);
    }
    if (tag < kOnlyTag || tag >= kOnlyTag + num_left) {
      paint(outline, image);
    }
  }
}

/// Covers a quarter of the payload: too many wrong bits to decode.
void putThumbOnTag(const simulation::RenderedView& view, cv::Mat& image) {
  std::vector<Eigen::Vector2d> outline(4);
  const std::vector<int> ids = target::tagCornerIds(target::AprilGrid(), kOnlyTag);
  for (const simulation::TrueCorner& corner : view.corners) {
    for (std::size_t i = 0; i < 4; ++i) {
      outline[i] = corner.corner_id == ids[i] ? corner.px : outline[i];
    }
  }
  const Eigen::Vector2d centre = 0.25 * (outline[0] + outline[1] + outline[2] + outline[3]);
  constexpr double kPayload = 0.6;  // of the tag
  paint({centre, centre + 0.5 * kPayload * (outline[1] - centre + outline[0] - centre),
         centre + kPayload * (outline[1] - centre), centre + 0.5 * kPayload * (outline[1] - centre + outline[2] - centre)},
        image);
}

struct Recording {
  std::vector<std::vector<StampedImage>> images;  ///< by camera
};

Recording render() {
  simulation::LensRequest lens;
  lens.width = 640;
  lens.height = 560;
  simulation::RecordingOptions options;
  options.cameras = simulation::makeRig({simulation::makeLens(lens), simulation::makeLens(lens)}, 0.08, 0.05, 1);
  options.num_frames = static_cast<int>(kNumFrames);
  const simulation::Renderer renderer(simulation::makeRecording(options));
  Recording recording{{{}, {}}};
  for (std::size_t frame_index = 0; frame_index < kNumFrames; ++frame_index) {
    const simulation::RenderedFrame frame = renderer.render(static_cast<int>(frame_index));
    for (std::size_t camera = 0; camera < 2; ++camera) {
      cv::Mat image = frame.views[camera].image;
      const bool has_thumb = frame_index == kThumbFrame && camera == 1;
      if (frame_index == kTwoTagsFrame || has_thumb) {
        leaveTags(frame.views[camera], has_thumb ? 1 : 2, image);
      }
      if (has_thumb) {
        putThumbOnTag(frame.views[camera], image);
      }
      recording.images[camera].push_back({frame.stamp_ns, [image] { return image.clone(); }});
    }
  }
  return recording;
}

const Recording& recording() {
  static const Recording recording = render();
  return recording;
}

CalibrationResult run(int max_rounds) {
  std::vector<CameraStream> streams;
  for (std::size_t camera = 0; camera < 2; ++camera) {
    CameraStream stream{"/cam" + std::to_string(camera), kNumFrames, {}};
    stream.open = [camera] {
      auto next = std::make_shared<std::size_t>(0);
      return [camera, next]() -> std::optional<StampedImage> {
        const std::vector<StampedImage>& images = recording().images[camera];
        return *next < images.size() ? std::optional<StampedImage>(images[(*next)++]) : std::nullopt;
      };
    };
    streams.push_back(stream);
  }
  CalibrateOptions options;
  options.models = {"ds-none", "ds-none"};
  options.max_rounds = max_rounds;
  return calibrate(streams, target::AprilGrid(), options);
}

/// Corners of an image that the solve used; -1 where nothing was seen in it.
int usedCorners(const CalibrationResult& result, std::size_t camera, std::size_t frame) {
  const std::vector<CameraCorners> observed = observedCorners(result);
  for (const observation::CameraView& image : observed[camera].images) {
    if (image.stamp_ns == recording().images[camera][frame].stamp_ns) {
      return static_cast<int>(std::count_if(image.corners.begin(), image.corners.end(),
                                            [](const observation::Corner& corner) { return corner.used; }));
    }
  }
  return -1;
}

const CalibrationResult& without() {
  static const CalibrationResult result = run(0);
  return result;
}

const CalibrationResult& withOne() {
  static const CalibrationResult result = run(1);
  return result;
}

TEST(UntriedImagesTest, TwoTagsTakePartAfterARoundAndNotWithoutAny) {
  for (const std::size_t camera : {0U, 1U}) {
    EXPECT_EQ(usedCorners(without(), camera, kTwoTagsFrame), 0) << "seen, but left out as Kalibr does";
    EXPECT_EQ(usedCorners(withOne(), camera, kTwoTagsFrame), 8);
  }
}

TEST(UntriedImagesTest, WhereNothingWasDetectedTheOtherCameraSaysWhereToLook) {
  EXPECT_EQ(usedCorners(without(), 1, kThumbFrame), -1);
  EXPECT_EQ(usedCorners(withOne(), 1, kThumbFrame), 4);
}

}  // namespace
}  // namespace tartan_calib::pipeline
