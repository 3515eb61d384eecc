#include "calibrate_cameras/rig_file.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "common/program.h"

namespace tartan_calib::apps {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

constexpr std::array kFileFlags = {"bag", "corners", "init", "target"};

YAML::Node readMap(const std::string& file) {
  YAML::Node rig;
  try {
    rig = YAML::LoadFile(file);
  } catch (const YAML::BadFile&) {
    throw InputError("rig file " + file + " cannot be read: check the name after --rig");
  } catch (const YAML::ParserException& error) {
    throw InputError("rig file " + file + " is no YAML: line " + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
  if (!rig.IsMap()) {
    throw InputError("rig file " + file + " must hold flags as `key: value` lines, e.g. `models: [ds-none, ds-none]`");
  }
  return rig;
}

Words valuesOf(const YAML::Node& node, const std::string& flag, const std::string& file) {
  const bool is_list =
      node.IsSequence() && std::all_of(node.begin(), node.end(), [](const auto& n) { return n.IsScalar(); });
  if (is_list) {
    return node.as<Words>();
  }
  if (!node.IsScalar()) {
    throw InputError("rig file " + file + ": " + flag + " needs a value or a list of values");
  }
  return {node.Scalar()};
}

Words flagsOf(const std::string& file) {
  Words words;
  for (const auto& entry : readMap(file)) {
    if (!entry.first.IsScalar()) {
      throw InputError("rig file " + file + ": line " + std::to_string(entry.first.Mark().line + 1) +
                       ": the key must be the name of a flag, such as models");
    }
    const std::string flag = entry.first.Scalar();
    Words values = valuesOf(entry.second, flag, file);
    if (values == Words{"false"}) {
      continue;
    }
    words.push_back("--" + flag);
    if (values == Words{"true"}) {
      continue;
    }
    if (std::find(kFileFlags.begin(), kFileFlags.end(), flag) != kFileFlags.end()) {
      values.front() = (fs::path(file).parent_path() / values.front()).lexically_normal().string();
    }
    words.insert(words.end(), values.begin(), values.end());
  }
  return words;
}

}  // namespace

std::vector<std::string> withRigFile(const std::vector<std::string>& words) {
  const std::string flag = "--rig";
  for (auto word = words.begin(); word != words.end(); ++word) {
    const bool is_joined = word->compare(0, flag.size() + 1, flag + "=") == 0;
    if (!is_joined && *word != flag) {
      continue;
    }
    const auto value = is_joined ? word : std::next(word);
    if (value == words.end()) {
      throw UsageError("--rig needs a file; see --help");
    }
    Words result = flagsOf(is_joined ? value->substr(flag.size() + 1) : *value);
    result.insert(result.end(), words.begin(), word);
    result.insert(result.end(), std::next(value), words.end());
    return result;
  }
  return words;
}

}  // namespace tartan_calib::apps
