#include "calibrate_cameras/console.h"

#include <gtest/gtest.h>

namespace tartan_calib::apps {
namespace {

constexpr int kNumCameras = 2;

calibration::Rig rigOfTwo() {
  calibration::Rig rig;
  for (int i = 0; i < kNumCameras; ++i) {
    camera::Camera camera;
    camera.model = camera::startModel(camera::modelByName("pinhole-equi"), 300.0, {320.0, 240.0});
    camera.width = 640;
    camera.height = 480;
    const geometry::Rigid3 T_cam_rig(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-0.1 * i, 0.0, 0.0));
    rig.cameras.push_back({camera, T_cam_rig});
  }
  return rig;
}

Inputs inputsOfTwo() {
  Inputs inputs;
  inputs.dataset = "two.bag";
  inputs.topics = {"/cam0/image_raw", "/cam1/image_raw"};
  inputs.options.models = {"pinhole-equi", "pinhole-equi"};
  return inputs;
}

pipeline::CalibrationResult resultOfTwo() {
  pipeline::CalibrationResult result;
  result.target = target::AprilGrid{};
  result.solution.rig = rigOfTwo();
  result.solution.counts.resize(kNumCameras);
  result.solution.counts[1].outliers = 3;
  result.num_dropped_views = 1;
  observation::Corner corner;
  observation::View view;
  view.cameras.push_back({0, 0, {corner}});
  result.solution.views.push_back(view);
  view.cameras.front().corners.front().used = false;
  result.solution.views.push_back(view);
  for (const std::string& topic : inputsOfTwo().topics) {
    pipeline::CameraReport report;
    report.topic = topic;
    result.cameras.push_back(report);
  }
  return result;
}

/// Everything that a run prints, with the steps that pipeline::calibrate reports.
std::string outputOfRun() {
  const Inputs inputs = inputsOfTwo();
  Console console(inputs);
  const pipeline::Listener listener = console.listener();
  ::testing::internal::CaptureStdout();
  for (int i = 0; i < kNumCameras; ++i) {
    listener.progress({pipeline::Stage::kDetect, i, 0, 40});
    listener.progress({pipeline::Stage::kDetect, i, 40, 40});
    pipeline::CameraCorners corners;
    corners.num_images = 40;
    corners.images.resize(38);
    listener.camera_detected(i, corners);
    listener.camera_started(i, rigOfTwo().cameras.front().camera);
  }
  calibration::Problem problem;
  problem.rig = rigOfTwo();
  listener.rig_started(problem);
  console.printResult(resultOfTwo());
  console.printFiles({"two-camchain.yaml", "two-results-cam.txt", "two-calibration.yaml", "two-poses-cam0.csv", ""});
  console.printExports({"two-camchain.yaml", "two-results-cam.txt", "two-calibration.yaml", "two-poses-cam0.csv", ""});
  return ::testing::internal::GetCapturedStdout();
}

TEST(Console, KeepsKalibrsLinesInKalibrsOrder) {
  const std::string output = outputOfRun();
  std::size_t position = 0;
  for (const char* line : {"Initializing cam0:\n",
                           "\tCamera model:\t  pinhole-equi\n",
                           "\tDataset:          two.bag\n",
                           "\tTopic:            /cam0/image_raw\n",
                           "\tNumber of images: 40\n",
                           "Extracting calibration target corners\n",
                           "\n  Extracted corners for 38 images (of 40 images)\n",
                           "\tProjection initialized to: [300. 300. 320. 240.]\n",
                           "\tDistortion initialized to: [0. 0. 0. 0.]\n",
                           "Initializing cam1:\n",
                           "Topic:            /cam1/image_raw\n",
                           "initializing initial guesses\n",
                           "\t initializing camera pair (0,1)...  \n",
                           "initialized baseline between cam0 and cam1 to:\n[[",
                           "initialized cam0 to:\n\t projection cam0: [300. ",
                           "\t distortion cam0: [0. ",
                           "initialized cam1 to:\n\t projection cam1: [",
                           "initializing calibrator\n",
                           "starting calibration...\n",
                           "\nAll views have been processed.\n\nStarting final outlier filtering...\n",
                           "Calibration complete.\n",
                           "[ WARN] [",
                           "]: Removed 3 outlier corners.\n",
                           "Processed 3 images with 1 images used\n",
                           "Calibration results \n====================\nCamera-system parameters:\n",
                           "Target configuration\n",
                           "Results written to:\n  Saving camera chain calibration to file: two-camchain.yaml\n",
                           "  Detailed results written to file: two-results-cam.txt\n",
                           "Exporting poses...\n  Poses written to two-poses-cam0.csv\n"}) {
    const std::size_t found = output.find(line, position);
    ASSERT_NE(found, std::string::npos) << "missing or too early: " << line << "\nin:\n" << output;
    position = found;
  }
  EXPECT_EQ(output.find("Exporting corners"), std::string::npos);
}

TEST(Console, ShowsNoControlCharactersWhereThereIsNoTerminal) {
  const std::string output = outputOfRun();
  EXPECT_EQ(output.find('\r'), std::string::npos);
  EXPECT_EQ(output.find('\x1b'), std::string::npos);
}

TEST(Console, IntroducesCamerasThatComeFromACornersFile) {
  Inputs inputs = inputsOfTwo();
  inputs.corners.resize(kNumCameras);
  Console console(inputs);
  pipeline::CameraCorners corners;
  corners.num_images = 12;
  ::testing::internal::CaptureStdout();
  console.listener().camera_detected(1, corners);
  const std::string output = ::testing::internal::GetCapturedStdout();
  EXPECT_EQ(output.find("Initializing cam1:\n"), 0U) << output;
  EXPECT_NE(output.find("Number of images: 12\n"), std::string::npos) << output;
}

}  // namespace
}  // namespace tartan_calib::apps
