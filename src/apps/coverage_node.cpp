#include "coverage_node/coverage_node.h"
#include "live/node.h"

namespace {

using namespace tartan_calib;

constexpr const char* kHelp =
    R"(Watches cameras, says where to hold the board next, keeps the best views and calibrates with them.

  rosrun tartan_calib coverage_node _topics:="/cam0/image_raw /cam1/image_raw" _models:="ds-none ds-none" _target:=board.yaml
  rosrun image_view image_view image:=/coverage_node/cam0/overlay
  rosservice call /coverage_node/calibrate

roslaunch tartan_calib record.launch does that and records a bag beside it. Parameters (docs/live.md has topics and services too):

  ~topics          image topics; those that end with /compressed carry compressed images
  ~models          a camera model for each; calibrate_cameras --help lists them
  ~target          YAML file of the board
  ~output          the results are <output>-camchain.yaml, ..., the kept views <output>.bag; in a folder that is
                   there (live)
  ~options         further flags of calibrate_cameras (none)
  ~max_rate        views per second that are looked at, 0: as many as the machine can (0)
  ~max_views       that are kept (100)
  ~max_memory_mb   for their images (512)
  ~max_blur_px     of the edges of the board in views that are kept (2)
  ~min_gain_bits   that a view has to add to what is known (0.1)
  ~overlay_width   of the published pictures, at most, in pixels (800)
)";

}  // namespace

int main(int argc, char** argv) {
  return apps::runNode(argc, argv, {"coverage_node", kHelp}, [](::ros::NodeHandle& node, ::ros::NodeHandle& private_node) {
    apps::CoverageNode(node, private_node, apps::coverageOptions(apps::Parameters(private_node), node)).run();
  });
}
