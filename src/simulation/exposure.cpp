#include "exposure.h"

#include <algorithm>
#include <cmath>

#include "hand_layer.h"
#include "tartan_calib/simulation/board_layer.h"

namespace tartan_calib::simulation {
namespace {

bool isBehindBoard(const geometry::Rigid3& T_cam_target) { return T_cam_target.inverse().translation.z() <= 0.0; }

cv::Mat twice(const cv::Mat& channel) {
  cv::Mat both;
  cv::merge(std::vector<cv::Mat>{channel, channel}, both);
  return both;
}

/// Adds up moments of the exposure, each over the same room.
class MomentSum {
 public:
  MomentSum(const cv::Mat1f& room, const cv::Mat1f& board_light, const Lighting& lighting)
      : room_(room),
        board_light_(board_light),
        lighting_(lighting),
        sum_(cv::Mat1f(room.size(), 0.0F)),
        derivative_(cv::Mat2f(room.size(), cv::Vec2f(0.0F, 0.0F))) {}

  void add(const BoardLayer& board, const HandLayer& hand) {
    cv::Mat moment = room_.clone();
    if (!board.window.empty()) {
      addBoard(moment(board.window), board);
    }
    if (!hand.window.empty()) {
      addHand(moment(hand.window), hand);
    }
    sum_ += moment;
    ++num_moments_;
  }

  Exposure mean() const {
    Exposure exposure;
    exposure.light = sum_ / num_moments_;
    exposure.board_window = board_window_;
    if (!board_window_.empty()) {
      exposure.light_derivative = derivative_(board_window_) / num_moments_;
    }
    exposure.occluded = occluded_;
    return exposure;
  }

 private:
  void addBoard(cv::Mat seen, const BoardLayer& board) {
    const cv::Mat light = board_light_(board.window);
    const double contrast = lighting_.white_grey - lighting_.black_grey;
    const cv::Mat paper = board.sheet * lighting_.black_grey + board.white * contrast;
    const cv::Mat uncovered = 1.0F - board.sheet;
    const cv::Mat mixed = seen.mul(uncovered) + paper.mul(light);
    mixed.copyTo(seen);
    cv::Mat derivative = derivative_(board.window);
    derivative += board.white_derivative.mul(twice(light * contrast));
    board_window_ |= board.window;
  }

  void addHand(cv::Mat seen, const HandLayer& hand) {
    const cv::Mat uncovered = 1.0F - hand.cover;
    const cv::Mat mixed = seen.mul(uncovered) + hand.light;
    mixed.copyTo(seen);
    if (occluded_.empty()) {
      occluded_ = cv::Mat1b(room_.size(), static_cast<unsigned char>(0));
    }
    constexpr double kRoundingOfCoverage = 1e-4;
    cv::Mat occluded = occluded_(hand.window);
    cv::bitwise_or(occluded, hand.cover > kRoundingOfCoverage, occluded);
  }

  const cv::Mat1f& room_;
  const cv::Mat1f& board_light_;
  const Lighting& lighting_;
  int num_moments_ = 0;
  cv::Mat sum_;
  cv::Mat derivative_;
  cv::Rect board_window_;
  cv::Mat1b occluded_;
};

}  // namespace

ExposureMaker::ExposureMaker(const Scene& scene, const SceneCamera& camera)
    : camera_(camera),
      room_directions_(Room::directions(camera.camera, camera.T_cam_rig)),
      shading_(lensShading(camera)),
      board_light_(camera, scene.lighting) {}

std::vector<geometry::Rigid3> ExposureMaker::boardPoses(const Scene& scene, const SceneFrame& frame) const {
  const auto pose_at = [&](double s) { return boardPose(camera_, frame) * geometry::expRigid(s * frame.motion); };
  double longest_px = 0.0;
  for (const Eigen::Vector3d& p_target : target::cornerPoints(scene.target)) {
    const auto first = camera::project(camera_.camera.model, pose_at(-0.5) * p_target);
    const auto last = camera::project(camera_.camera.model, pose_at(0.5) * p_target);
    if (first && last && camera::isInside(camera_.camera, *first)) {
      longest_px = std::max(longest_px, (*last - *first).norm());
    }
  }
  constexpr double kMomentsPerPixel = 2.0;
  const int num_moments = longest_px > 0.0 ? static_cast<int>(std::ceil(kMomentsPerPixel * longest_px)) : 1;
  std::vector<geometry::Rigid3> poses;
  for (int i = 0; i < num_moments; ++i) {
    poses.push_back(pose_at((i + 0.5) / num_moments - 0.5));
  }
  return poses;
}

Exposure ExposureMaker::expose(const Scene& scene, const BoardPattern& pattern, const Room& room,
                               const SceneFrame& frame) const {
  const cv::Mat1f behind = room.view(room_directions_, frame.heading_rad);
  const geometry::Rigid3 T_cam_target = boardPose(camera_, frame);
  const double side = isBehindBoard(T_cam_target) ? -1.0 : 1.0;
  const cv::Mat1f on_board = board_light_.onBoard(side * (T_cam_target.rotation * Eigen::Vector3d::UnitZ()));
  MomentSum sum(behind, on_board, scene.lighting);
  for (const geometry::Rigid3& pose : boardPoses(scene, frame)) {
    const bool shows_hand = frame.hand && !isBehindBoard(pose);
    sum.add(drawBoard(pattern, camera_.camera, pose),
            shows_hand ? drawHand(*frame.hand, camera_.camera, pose) : HandLayer());
  }
  Exposure exposure = sum.mean();
  if (!exposure.occluded.empty()) {
    const HandLayer hand = drawHand(*frame.hand, camera_.camera, T_cam_target);
    exposure.cover = cv::Mat1f(exposure.light.size(), 0.0F);
    if (!hand.window.empty()) {  // it may be out of view in the middle
      hand.cover.copyTo(exposure.cover(hand.window));
    }
  }
  exposure.light = exposure.light.mul(shading_, frame.exposure_ratio);
  applyPsf(exposure.light, scene.sensor.psf_sigma_px);
  if (!exposure.board_window.empty()) {
    exposure.light_derivative = exposure.light_derivative.mul(twice(shading_(exposure.board_window)), frame.exposure_ratio);
    applyPsf(exposure.light_derivative, scene.sensor.psf_sigma_px);
  }
  return exposure;
}

}  // namespace tartan_calib::simulation
