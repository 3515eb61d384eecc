#include "coverage_node/coverage_node.h"

#include <ros/init.h>
#include <ros/spinner.h>

#include "common/program.h"

namespace {

using namespace tartan_calib;

/// Images and services are taken in beside the work.
constexpr std::uint32_t kNumCallbackThreads = 2;

int run() {
  ::ros::NodeHandle node;
  ::ros::NodeHandle private_node("~");
  apps::CoverageNode coverage(node, private_node, apps::coverageOptions(apps::Parameters(private_node), node));
  ::ros::AsyncSpinner spinner(kNumCallbackThreads);
  spinner.start();
  coverage.run();
  spinner.stop();
  return apps::kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  ::ros::init(argc, argv, "coverage_node");
  return apps::runProgram(run);
}
