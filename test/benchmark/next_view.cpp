/// Where the advice of the coverage node leads: next_view <model> <field of view in degrees> <seed>
///
/// Twelve random views of a board, then twelve more: random again, or each where guidance says that a view adds most. Prints
/// the expected error of the projection, rms over the image [px] for corners with a stdev of 0.3 px, after 12, 18 and 24
/// views: first random, then advised.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "tartan_calib/calibration/compare.h"
#include "tartan_calib/calibration/information.h"
#include "tartan_calib/guidance/board_candidates.h"
#include "tartan_calib/guidance/information.h"
#include "tartan_calib/report/uncertainty.h"
#include "tartan_calib/simulation/lens.h"

namespace {

using namespace tartan_calib;
using geometry::Rigid3;
using guidance::BoardCandidate;

constexpr double kNoise_px = 0.3;
constexpr int kNumBefore = 12;
constexpr int kNumMore = 12;
constexpr int kReportEvery = 6;

double expectedError(const calibration::Rig& rig, const Eigen::MatrixXd& known) {
  const camera::Camera& camera = rig.cameras.front().camera;
  calibration::Solution solution;
  solution.rig = rig;
  solution.covariance = kNoise_px * kNoise_px * known.inverse();
  constexpr double kSpacing_px = 40.0;
  const auto grid_px = calibration::imageGrid(camera.width, camera.height, kSpacing_px);
  double sum_px2 = 0.0;
  int count = 0;
  for (const auto& stdev_px : report::projectionStdevs(solution, 0, grid_px, grid_px)) {
    sum_px2 += stdev_px ? *stdev_px * *stdev_px : 0.0;
    count += stdev_px ? 1 : 0;
  }
  return std::sqrt(sum_px2 / count);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: next_view <model> <field of view in degrees> <seed>\n", stderr);
    return 2;
  }
  const std::string lens = (std::atof(argv[2]) < 100.0 ? "pinhole" : "fisheye") + std::string(argv[2]);
  const camera::Camera camera = simulation::makeLens({lens, argv[1], 0, 0}).camera;
  const calibration::Rig rig{{{camera, Rigid3()}}};
  const auto points = target::cornerPoints(target::AprilGrid{});
  guidance::CoverageMap lit(camera.width, camera.height);
  lit.addImage(cv::Mat(camera.height, camera.width, CV_8UC1, cv::Scalar(128)));
  const std::vector<BoardCandidate> candidates = guidance::boardCandidates(rig, points, {lit});

  std::mt19937 random(static_cast<unsigned>(std::atoi(argv[3])));
  const auto any = [&] { return candidates[random() % candidates.size()].information; };
  Eigen::MatrixXd known = guidance::priorInformation(rig);
  for (int i = 0; i < kNumBefore; ++i) {
    known += any();
  }
  Eigen::MatrixXd waved = known;
  Eigen::MatrixXd advised = known;
  for (int i = 0; i <= kNumMore; ++i) {
    if (i % kReportEvery == 0) {
      std::printf("%d %.4f %.4f\n", kNumBefore + i, expectedError(rig, waved), expectedError(rig, advised));
    }
    waved += any();
    const auto best = std::max_element(candidates.begin(), candidates.end(), [&](const auto& a, const auto& b) {
      return guidance::gainBits(advised, a.information) < guidance::gainBits(advised, b.information);
    });
    advised += best->information;
  }
  return 0;
}
