#include "board_motion.h"

#include <algorithm>
#include <set>

namespace tartan_calib::report {
namespace {

constexpr double kNsPerMs = 1e6;
constexpr std::int64_t kMaxGap_ns = 400'000'000;  ///< between neighbouring views; over longer ones a motion is no line

/// Mean square of the way that a small motion in the rig frame moves the points.
double squaredWay(const geometry::Vector6d& motion, const std::vector<Eigen::Vector3d>& points_rig) {
  double sum_m2 = 0.0;
  for (const Eigen::Vector3d& p : points_rig) {
    sum_m2 += (motion.head<3>() + motion.tail<3>().cross(p)).squaredNorm();
  }
  return sum_m2 / static_cast<double>(points_rig.size());
}

}  // namespace

BoardMotions boardMotions(const calibration::Solution& solution, const std::vector<Eigen::Vector3d>& points) {
  constexpr double kMaxBend = 0.5;  // half of the two ways' difference, of their mean
  BoardMotions motions(solution.views.size());
  const std::set<int> unsolved(solution.unsolved_views.begin(), solution.unsolved_views.end());
  const auto motion = [&](std::size_t from, std::int64_t duration_ns) -> geometry::Vector6d {
    const geometry::Rigid3 change = solution.T_rig_target[from + 1] * solution.T_rig_target[from].inverse();
    return geometry::logRigid(change) * (kNsPerMs / static_cast<double>(duration_ns));
  };
  for (std::size_t i = 1; i + 1 < motions.size(); ++i) {
    const std::int64_t before_ns = solution.views[i].stamp_ns - solution.views[i - 1].stamp_ns;
    const std::int64_t after_ns = solution.views[i + 1].stamp_ns - solution.views[i].stamp_ns;
    const int view = static_cast<int>(i);
    const bool is_solved = unsolved.count(view - 1) + unsolved.count(view) + unsolved.count(view + 1) == 0;
    if (!is_solved || before_ns <= 0 || after_ns <= 0 || std::max(before_ns, after_ns) >= kMaxGap_ns) {
      continue;
    }
    const geometry::Vector6d before = motion(i - 1, before_ns);
    const geometry::Vector6d after = motion(i, after_ns);
    const geometry::Vector6d mean = 0.5 * (before + after);
    std::vector<Eigen::Vector3d> points_rig;
    for (const Eigen::Vector3d& p_target : points) {
      points_rig.push_back(solution.T_rig_target[i] * p_target);
    }
    if (squaredWay(0.5 * (after - before), points_rig) < kMaxBend * kMaxBend * squaredWay(mean, points_rig)) {
      motions[i] = mean;
    }
  }
  return motions;
}

}  // namespace tartan_calib::report
