#include "tartan_calib/simulation/recording.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>

#include "lens_shading.h"
#include "random.h"
#include "tartan_calib/error.h"

namespace tartan_calib::simulation {
namespace {

constexpr std::int64_t kFirstStampNs = 1600000000000000000;
constexpr double kNsPerSecond = 1e9;

/// Size and middle of the pattern.
struct BoardExtent {
  Eigen::Vector3d centre;
  double size_m;  ///< mean of width and height
};

BoardExtent boardExtent(const target::Target& target) {
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(target);
  return {0.5 * (points.front() + points.back()), 0.5 * (points.back() - points.front()).head<2>().cwiseAbs().sum()};
}

/// Swings between -1 and 1, smooth and never the same twice: two sines of unrelated frequency.
class Swing {
 public:
  Swing(double cycles, Random& random)
      : cycles_(cycles), first_rad_(random.uniform(0.0, 2.0 * M_PI)), second_rad_(random.uniform(0.0, 2.0 * M_PI)) {}

  double at(double time) const {
    constexpr double kGoldenRatio = 1.618033988749895;
    const double turn = 2.0 * M_PI * cycles_ * time;
    return 0.6 * std::sin(turn + first_rad_) + 0.4 * std::sin(kGoldenRatio * turn + second_rad_);
  }

 private:
  double cycles_;
  double first_rad_;
  double second_rad_;
};

int framesPerCamera(const RecordingOptions& options) {
  return options.num_frames / static_cast<int>(options.cameras.size());
}

/// How the board goes through the field of view of one camera, for time from 0 to 1.
class BoardPath {
 public:
  BoardPath(const SceneCamera& lens, const RecordingOptions& options, Random& random)
      : lens_(lens),
        board_(boardExtent(options.target)),
        reach_ratio_(options.reach_ratio),
        max_tilt_rad_(options.max_tilt_rad),
        num_turns_(std::clamp(kTurnsOfRootFrames * std::sqrt(framesPerCamera(options)), kMinTurns, kMaxTurns)),
        first_azimuth_rad_(random.uniform(0.0, 2.0 * M_PI)),
        size_(num_turns_, random),
        tilt_x_(kSwingsPerTurn * num_turns_, random),
        tilt_y_(kSwingsPerTurn * num_turns_, random),
        roll_(num_turns_, random) {}

  geometry::Rigid3 T_cam_target(double time) const {
    constexpr double kMaxRollRad = 0.8;
    constexpr double kMeanSizeOfImage = 0.45;
    constexpr double kSizeSwing = 0.38;
    const Aim aim = aimAt(time);
    const int short_side_px = std::min(lens_.camera.width, lens_.camera.height);
    const double board_px = kMeanSizeOfImage * (1.0 + kSizeSwing * size_.at(time)) * short_side_px;
    const double distance_m = board_.size_m / (board_px * aim.rad_per_px);
    const Eigen::Quaterniond to_aim = geometry::rotationBetween(Eigen::Vector3d::UnitZ(), aim.ray);
    const Eigen::Quaterniond tilt =
        geometry::expRotation(max_tilt_rad_ * Eigen::Vector3d(tilt_x_.at(time), tilt_y_.at(time), 0.0));
    const Eigen::Quaterniond roll = geometry::expRotation({0.0, 0.0, kMaxRollRad * roll_.at(time)});
    const Eigen::Quaterniond facing(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
    const Eigen::Quaterniond R_cam_target = to_aim * tilt * roll * facing;
    return geometry::Rigid3(R_cam_target, distance_m * aim.ray - R_cam_target * board_.centre);
  }

 private:
  static constexpr double kTurnsOfRootFrames = 0.5;  ///< as far apart along the spiral as from turn to turn
  static constexpr double kMinTurns = 2.0;
  static constexpr double kMaxTurns = 12.0;
  static constexpr double kSwingsPerTurn = 1.3;

  struct Aim {
    Eigen::Vector3d ray;
    double rad_per_px;
  };

  /// From the axis to the rim on a spiral whose turns and steps cover the image evenly.
  Aim aimAt(double time) const {
    const Eigen::Vector2d centre_px = principalPoint(lens_.camera);
    const double spiral = std::sqrt(time);
    const double azimuth_rad = first_azimuth_rad_ + 2.0 * M_PI * num_turns_ * spiral;
    const Eigen::Vector2d direction(std::cos(azimuth_rad), std::sin(azimuth_rad));
    double radius_px = reach_ratio_ * spiral * rimAlong(centre_px, direction);
    for (;; radius_px *= 0.98) {
      const Eigen::Vector2d px = centre_px + radius_px * direction;
      const auto ray = camera::unproject(lens_.camera.model, px);
      const auto right = camera::unproject(lens_.camera.model, px + Eigen::Vector2d::UnitX());
      const auto below = camera::unproject(lens_.camera.model, px + Eigen::Vector2d::UnitY());
      if (ray && right && below) {
        return {*ray, std::sqrt(ray->cross(*right).norm() * ray->cross(*below).norm())};
      }
    }
  }

  /// Distance from the centre to the border of the image or of the lens' circle.
  double rimAlong(const Eigen::Vector2d& centre_px, const Eigen::Vector2d& direction) const {
    const Eigen::Vector2d last(lens_.camera.width - 1.0, lens_.camera.height - 1.0);
    double rim_px = lens_.image_circle_px;
    for (int axis = 0; axis < 2; ++axis) {
      const double room_px = direction(axis) > 0.0 ? last(axis) - centre_px(axis) : centre_px(axis);
      rim_px = std::min(rim_px, room_px / std::max(std::abs(direction(axis)), 1e-9));
    }
    return rim_px;
  }

  const SceneCamera& lens_;
  BoardExtent board_;
  double reach_ratio_;
  double max_tilt_rad_;
  double num_turns_;
  double first_azimuth_rad_;
  Swing size_;
  Swing tilt_x_;
  Swing tilt_y_;
  Swing roll_;
};

/// A shake of the board about its centre whose corners move by `path_px` on average in the picture of `lens`.
geometry::Vector6d shake(const SceneCamera& lens, const SceneFrame& frame, const RecordingOptions& options, double path_px,
                         Random& random) {
  constexpr double kTurnOfShift = 0.5;
  constexpr double kTinyShift = 1e-4;  // of the board's size; the path is linear in it
  const BoardExtent board = boardExtent(options.target);
  const Eigen::Vector3d shift = board.size_m * random.normalVector();
  const Eigen::Vector3d turn = kTurnOfShift * random.normalVector();
  geometry::Vector6d motion;
  motion << shift - turn.cross(board.centre), turn;
  const geometry::Rigid3 before = lens.T_cam_rig * frame.T_rig_target;
  const geometry::Rigid3 after = before * geometry::expRigid(kTinyShift * motion);
  double sum_px = 0.0;
  int count = 0;
  for (const Eigen::Vector3d& p_target : target::cornerPoints(options.target)) {
    const auto from = camera::project(lens.camera.model, before * p_target);
    const auto to = camera::project(lens.camera.model, after * p_target);
    if (from && to && camera::isInside(lens.camera, *from)) {
      sum_px += (*to - *from).norm();
      ++count;
    }
  }
  return count > 0 && sum_px > 0.0 ? geometry::Vector6d(motion * kTinyShift * path_px * count / sum_px)
                                   : geometry::Vector6d(geometry::Vector6d::Zero());
}

/// A hand that reaches into the board from somewhere around it.
Hand reachingHand(const target::Target& target, Random& random) {
  constexpr double kBoardOfAdultHand = 0.6;  // [m]; smaller boards get smaller hands, as children's boards would
  const BoardExtent board = boardExtent(target);
  const double from_rad = random.uniform(0.0, 2.0 * M_PI);
  const double reach_m = random.uniform(0.22, 0.5) * board.size_m;
  Hand hand;
  hand.palm_m = board.centre.head<2>() + reach_m * Eigen::Vector2d(std::cos(from_rad), std::sin(from_rad));
  hand.direction_rad = from_rad + M_PI + 0.35 * random.normal();
  hand.scale = std::clamp(board.size_m / kBoardOfAdultHand, 0.3, 1.1);
  return hand;
}

/// Which of `count` frames have a property that `ratio` of them have.
std::vector<bool> chooseFrames(int count, double ratio, Random& random) {
  std::vector<std::size_t> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1], order[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i)))]);
  }
  std::vector<bool> chosen(order.size(), false);
  const auto num_chosen = static_cast<std::size_t>(std::lround(ratio * count));
  for (std::size_t i = 0; i < num_chosen; ++i) {
    chosen[order[i]] = true;
  }
  return chosen;
}

void check(const RecordingOptions& options) {
  const auto is_ratio = [](double value) { return value >= 0.0 && value <= 1.0; };
  if (options.cameras.empty() || options.num_frames < 1) {
    throw InputError("a recording needs at least one camera and one view");
  }
  if (!(options.rate_hz > 0.0) || !is_ratio(options.blurred_ratio) || !is_ratio(options.hand_ratio) ||
      !(options.max_blur_px >= 0.0)) {
    throw InputError(
        "the rate must be positive, the parts of blurred and covered views within 0 and 1, the blur not negative");
  }
}

}  // namespace

std::vector<SceneCamera> makeRig(const std::vector<SceneCamera>& lenses, double baseline_m, double yaw_rad,
                                 std::uint64_t seed) {
  constexpr double kMountRad = 0.01;
  constexpr double kMountM = 0.002;
  Random random(seed);
  std::vector<SceneCamera> rig = lenses;
  for (std::size_t k = 1; k < rig.size(); ++k) {
    const Eigen::Quaterniond yaw = geometry::expRotation({0.0, yaw_rad, 0.0});
    const Eigen::Quaterniond off = geometry::expRotation(kMountRad * random.normalVector());
    const Eigen::Vector3d place = Eigen::Vector3d(baseline_m, 0.0, 0.0) + kMountM * random.normalVector();
    const geometry::Rigid3 T_previous_this(yaw * off, place);
    rig[k].T_cam_rig = T_previous_this.inverse() * rig[k - 1].T_cam_rig;
  }
  return rig;
}

Scene makeRecording(const RecordingOptions& options) {
  check(options);
  Random random(options.seed);
  const int num_cameras = static_cast<int>(options.cameras.size());
  std::vector<BoardPath> paths;
  for (const SceneCamera& camera : options.cameras) {
    paths.emplace_back(camera, options, random);
  }
  const std::vector<bool> is_blurred = chooseFrames(options.num_frames, options.blurred_ratio, random);
  const std::vector<bool> has_hand = chooseFrames(options.num_frames, options.hand_ratio, random);
  const Swing heading(1.0, random);
  const double first_heading_rad = random.uniform(0.0, 2.0 * M_PI);

  Scene scene;
  scene.target = options.target;
  scene.cameras = options.cameras;
  scene.sensor = options.sensor;
  scene.seed = options.seed;
  const double period = static_cast<double>(num_cameras) / options.num_frames;  // between frames, of a path
  for (int i = 0; i < options.num_frames; ++i) {
    const double turn = static_cast<double>(i) * num_cameras / options.num_frames;
    const auto camera_index = static_cast<std::size_t>(turn);
    const SceneCamera& lens = options.cameras[camera_index];
    SceneFrame frame;
    frame.exposure_ratio = options.exposure_ratio;
    frame.stamp_ns = kFirstStampNs + std::llround(i * kNsPerSecond / options.rate_hz);
    const double time = turn - static_cast<double>(camera_index);
    const geometry::Rigid3 T_cam_target = paths[camera_index].T_cam_target(time);
    const geometry::Rigid3 T_cam_next = paths[camera_index].T_cam_target(time + period);
    frame.T_rig_target = lens.T_cam_rig.inverse() * T_cam_target;
    frame.velocity = options.rate_hz * geometry::logRigid(T_cam_target.inverse() * T_cam_next);
    frame.heading_rad = first_heading_rad + 0.5 * heading.at(static_cast<double>(i) / options.num_frames);
    if (is_blurred[static_cast<std::size_t>(i)]) {
      frame.motion = shake(lens, frame, options, random.uniform(0.15, 1.0) * options.max_blur_px, random);
    }
    if (has_hand[static_cast<std::size_t>(i)]) {
      frame.hand = reachingHand(options.target, random);
    }
    scene.frames.push_back(frame);
  }
  return scene;
}

}  // namespace tartan_calib::simulation
