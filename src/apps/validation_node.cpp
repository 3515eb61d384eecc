#include "validation_node/validation_node.h"

#include "live/node.h"

namespace {

using namespace tartan_calib;

constexpr const char* kHelp =
    R"(Watches calibrated cameras and tells how far a board's corners are from where the calibration puts them.

  rosrun tartan_calib validation_node _camchain:=rig-camchain.yaml _target:=board.yaml
  rosrun image_view image_view image:=/validation_node/cam0/overlay

roslaunch tartan_calib validate.launch does that. Parameters (docs/live.md has the topics too; --help prints this):

  ~camchain        calibration of the cameras, which stays as it is
  ~target          YAML file of the board
  ~topics          image topics, one per camera (those of the camchain)
  ~approx_sync     largest difference of stamps in one view of a rig, in seconds (0.02)
  ~max_rate        views per second that are looked at, 0: as many as the machine can (0)
  ~max_rms_px      reprojection error above which a camera's status is a warning (1)
  ~overlay_width   of the published pictures, at most, in pixels (800)
)";

}  // namespace

int main(int argc, char** argv) {
  return apps::runNode(argc, argv, {"validation_node", kHelp}, [](::ros::NodeHandle& node, ::ros::NodeHandle& private_node) {
    apps::ValidationNode(node, private_node, apps::validationOptions(apps::Parameters(private_node), node)).run();
  });
}
