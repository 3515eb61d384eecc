#include "shared_bag.h"

#include <rosbag/view.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "tartan_calib/text.h"

namespace tartan_calib::ros {
namespace {

void checkIsBag(const std::string& path) {
  if (!std::filesystem::exists(path)) {
    throw InputError("bag " + path + " does not exist: check the path");
  }
  const std::string magic = "#ROSBAG V";
  std::string begin(magic.size(), '\0');
  if (!std::ifstream(path, std::ios::binary).read(&begin[0], static_cast<std::streamsize>(begin.size())) || begin != magic) {
    throw InputError(path +
                     " is not a ROS 1 bag, or cannot be read; bags of ROS 2 need to be converted, e.g. by rosbags-convert");
  }
}

}  // namespace

InputError damagedBag(const std::string& path, const std::string& reason) {
  return InputError("bag " + path + " is damaged or cut off (" + reason + "): run 'rosbag reindex " + path + "'");
}

std::shared_ptr<SharedBag> openShared(const std::string& path) {
  checkIsBag(path);
  auto shared = std::make_shared<SharedBag>();
  shared->path = path;
  try {
    shared->bag.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError("bag " + path + " has no index, as after an interrupted recording: run 'rosbag reindex " + path + "'");
  } catch (const std::exception& error) {
    throw damagedBag(path, error.what());
  }
  return shared;
}

std::map<std::string, std::string> typesByTopic(const rosbag::Bag& bag) {
  std::map<std::string, std::set<std::string>> all;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    all[connection->topic].insert(connection->datatype);
  }
  std::map<std::string, std::string> types;
  for (const auto& [topic, names] : all) {
    types[topic] = joined({names.begin(), names.end()}, kTypeSeparator);
  }
  return types;
}

bool isImageType(const std::string& type) { return type == kImageType || type == kCompressedType; }

bool hasReadableEncoding(const MessageHead& head) {
  return std::all_of(head.encoding.begin(), head.encoding.end(), [](char letter) { return letter >= ' ' && letter <= '~'; });
}

}  // namespace tartan_calib::ros
