#pragma once

#include <ros/node_handle.h>

#include <functional>

namespace tartan_calib::apps {

struct NodeDescription {
  const char* name;
  const char* help;  ///< text of --help
};

/// The main() of a node: answers --help, refuses flags, connects to the master and runs the body, which ends when the node
/// is shut down. Callbacks are served by other threads meanwhile. What the body throws is told as by runProgram.
int runNode(int argc, char** argv, const NodeDescription& description,
            const std::function<void(::ros::NodeHandle& node, ::ros::NodeHandle& private_node)>& body);

}  // namespace tartan_calib::apps
