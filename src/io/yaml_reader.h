#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>
#include <vector>

namespace tartan_calib::io {

/// The document as a map. Throws InputError with name, line and the parser's reason where it is none,
/// and where a key is there twice.
YAML::Node parseYamlMap(const std::string& text, const std::string& name);

/// Value of a scalar that YAML reads as that type; empty for anything else, quoted numbers among them.
std::optional<int> yamlInt(const YAML::Node& node);
std::optional<double> yamlNumber(const YAML::Node& node);  ///< float or int, finite
std::optional<bool> yamlBool(const YAML::Node& node);
std::optional<std::string> yamlText(const YAML::Node& node);
std::optional<std::vector<double>> yamlNumbers(const YAML::Node& node);  ///< of a sequence
std::optional<std::vector<int>> yamlInts(const YAML::Node& node);

/// `file:line` of a node, `file` where it has no place.
std::string yamlPlace(const std::string& name, const YAML::Node& node);

bool isYamlQuoted(const YAML::Node& node);

/// What stands there, cut to a readable length.
std::string yamlExcerpt(const YAML::Node& node);

}  // namespace tartan_calib::io
