#include "live/node.h"

#include <ros/init.h>
#include <ros/spinner.h>

#include <iostream>
#include <string>
#include <vector>

#include "common/program.h"

namespace tartan_calib::apps {
namespace {

/// Images and services are taken in beside the work.
constexpr std::uint32_t kNumCallbackThreads = 2;

void checkFlags(int argc, char** argv) {
  std::vector<std::string> words;
  ::ros::removeROSArgs(argc, argv, words);
  if (words.size() > 1) {
    throw UsageError("unrecognised option '" + words[1] + "': a node takes parameters, such as _topics:=...; see --help");
  }
}

}  // namespace

int runNode(int argc, char** argv, const NodeDescription& description,
            const std::function<void(::ros::NodeHandle& node, ::ros::NodeHandle& private_node)>& body) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (argc == 1 || first == "--help" || first == "-h") {
    std::cout << description.help;
    return argc == 1 ? kWrongUsage : kSuccess;
  }
  return runProgram([&] {
    checkFlags(argc, argv);
    ::ros::init(argc, argv, description.name);
    ::ros::NodeHandle node;
    ::ros::NodeHandle private_node("~");
    ::ros::AsyncSpinner spinner(kNumCallbackThreads);
    spinner.start();
    body(node, private_node);
    return kSuccess;
  });
}

}  // namespace tartan_calib::apps
