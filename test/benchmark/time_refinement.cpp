#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "board_poses.h"
#include "common/program.h"
#include "tartan_calib/detection/corner_recovery.h"
#include "tartan_calib/io/camchain.h"
#include "tartan_calib/io/corners_csv.h"
#include "tartan_calib/io/target_yaml.h"
#include "tartan_calib/ros/bag_reader.h"

namespace {

using namespace tartan_calib;

constexpr const char* kHelp =
    R"(Processor time of each way to refine a corner, sampled through a calibrated lens as in a round.

  time_refinement recording.bag corners.csv target.yaml camchain.yaml

One camera. The board's poses are solved from the corners; each refinement starts within a quarter of a pixel of them, where the
search for a corner ends. Prints the name of each, the number of corners and the time of one [us].
)";

constexpr int kNumFiles = 4;
constexpr int kNumRepeats = 3;  ///< the fastest counts: whatever else the machine does only adds

const std::array<std::pair<const char*, detection::Refinement>, 3> kRefinements = {
    {{"symmetry", detection::Refinement::kSymmetry},
     {"adaptive", detection::Refinement::kAdaptive},
     {"fixed", detection::Refinement::kFixed}}};

/// One image, and where its corners are looked for.
struct Search {
  cv::Mat gray;
  detection::BoardMap map;
  std::vector<detection::CornerSeed> seeds;
};

detection::BoardMap flatBoardMap(const camera::Camera& camera, const geometry::Rigid3& T_cam_target) {
  return [camera, T_cam_target](const Eigen::Vector2d& p_m) {
    return camera::project(camera.model, T_cam_target * Eigen::Vector3d(p_m.x(), p_m.y(), 0.0));
  };
}

std::vector<detection::CornerSeed> seedsAt(const std::vector<observation::Corner>& corners) {
  constexpr double kSearchStep_px = 0.5;
  std::vector<detection::CornerSeed> seeds;
  for (const observation::Corner& corner : corners) {
    seeds.push_back({corner.corner_id, (corner.px / kSearchStep_px).array().round() * kSearchStep_px});
  }
  return seeds;
}

std::vector<Search> openSearches(const std::vector<std::string>& files, const target::Target& target) {
  const pipeline::CameraCorners corners = io::loadCorners(files[1]).front();
  const calibration::Rig rig = io::loadCamchain(files[3]).rig;
  const auto poses = boardPoses(corners, target, rig);
  std::map<std::int64_t, std::vector<detection::CornerSeed>> seeds;
  for (const observation::CameraView& view : corners.images) {
    seeds[view.stamp_ns] = seedsAt(view.corners);
  }
  std::vector<Search> searches;
  const pipeline::ImageSource source = ros::openBag(files[0], {corners.topic}, {}).front().open();
  while (const auto image = source()) {
    const auto pose = poses.find(image->stamp_ns);
    if (pose != poses.end()) {
      searches.push_back({image->load(), flatBoardMap(rig.cameras.front().camera, pose->second), seeds[image->stamp_ns]});
    }
  }
  return searches;
}

/// Of all corners in all images [s].
double processorTime_s(const detection::CornerRecovery& recovery, const std::vector<Search>& searches) {
  const std::clock_t start = std::clock();
  for (const Search& search : searches) {
    for (const detection::CornerSeed& seed : search.seeds) {
      recovery.refine(search.gray, search.map, seed);
    }
  }
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

int run(const std::vector<std::string>& files) {
  if (files.size() != kNumFiles) {
    throw apps::UsageError(std::string("four files are needed\n") + kHelp);
  }
  const target::Target target = io::loadTarget(files[2]).target;
  const std::vector<Search> searches = openSearches(files, target);
  std::size_t num_corners = 0;
  for (const Search& search : searches) {
    num_corners += search.seeds.size();
  }
  if (num_corners == 0) {
    throw InputError(files[1] + " has no corners of images of " + files[0]);
  }
  for (const auto& [name, refinement] : kRefinements) {
    detection::RecoveryOptions options;
    options.refinement = refinement;
    const detection::CornerRecovery recovery(target, options);
    double fastest_s = processorTime_s(recovery, searches);
    for (int repeat = 1; repeat < kNumRepeats; ++repeat) {
      fastest_s = std::min(fastest_s, processorTime_s(recovery, searches));
    }
    std::cout << name << ' ' << num_corners << " corners " << 1e6 * fastest_s / static_cast<double>(num_corners) << " us\n";
  }
  return apps::kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  return apps::runProgram([&] { return run({argv + 1, argv + argc}); });
}
