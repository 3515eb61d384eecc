#include "yaml_reader.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <set>

#include "tartan_calib/error.h"

namespace tartan_calib::io {
namespace {

constexpr std::size_t kMaxExcerpt = 60;

/// Text of a scalar without quotes or explicit tag.
const std::string* plainScalar(const YAML::Node& node) {
  return node.IsDefined() && node.IsScalar() && node.Tag() == "?" ? &node.Scalar() : nullptr;
}

template <typename Value, typename Read>
std::optional<std::vector<Value>> sequence(const YAML::Node& node, const Read& read) {
  if (!node.IsDefined() || !node.IsSequence()) {
    return std::nullopt;
  }
  std::vector<Value> values;
  for (const YAML::Node& element : node) {
    const std::optional<Value> value = read(element);
    if (!value) {
      return std::nullopt;
    }
    values.push_back(*value);
  }
  return values;
}

/// Which of two values a parser takes is its own affair, so none of them is taken.
void rejectDuplicates(const YAML::Node& map, const std::string& name) {
  std::set<std::string> keys;
  for (const auto& entry : map) {
    if (entry.first.IsScalar() && !keys.insert(entry.first.Scalar()).second) {
      throw InputError(yamlPlace(name, entry.first) + ": the key '" + entry.first.Scalar() +
                       "' is there for the second time: keep one of them");
    }
  }
}

}  // namespace

YAML::Node parseYamlMap(const std::string& text, const std::string& name) {
  YAML::Node document;
  try {
    document = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError(name + ":" + std::to_string(error.mark.line + 1) + ": not valid YAML: " + error.msg);
  }
  if (!document.IsMap()) {
    throw InputError(name + ": expected YAML with 'key: value' lines");
  }
  rejectDuplicates(document, name);
  return document;
}

std::optional<int> yamlInt(const YAML::Node& node) {
  const std::string* text = plainScalar(node);
  int value = 0;
  if (text == nullptr) {
    return std::nullopt;
  }
  const char* begin = text->data() + (text->rfind('+', 0) == 0 ? 1 : 0);
  const char* end = text->data() + text->size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end) {
    return std::nullopt;
  }
  return value;
}

std::optional<double> yamlNumber(const YAML::Node& node) {
  const std::string* text = plainScalar(node);
  if (text == nullptr || text->find_first_not_of("0123456789+-.eE") != std::string::npos) {
    return std::nullopt;
  }
  char* end = nullptr;
  const double value = std::strtod(text->c_str(), &end);
  if (text->empty() || *end != '\0' || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::optional<bool> yamlBool(const YAML::Node& node) {
  bool value = false;
  if (plainScalar(node) == nullptr || !YAML::convert<bool>::decode(node, value)) {
    return std::nullopt;
  }
  return value;
}

std::optional<std::string> yamlText(const YAML::Node& node) {
  if (!node.IsDefined() || !node.IsScalar()) {
    return std::nullopt;
  }
  return node.Scalar();
}

std::optional<std::vector<double>> yamlNumbers(const YAML::Node& node) { return sequence<double>(node, yamlNumber); }

std::optional<std::vector<int>> yamlInts(const YAML::Node& node) { return sequence<int>(node, yamlInt); }

bool isYamlQuoted(const YAML::Node& node) { return node.IsDefined() && node.IsScalar() && node.Tag() == "!"; }

std::string yamlPlace(const std::string& name, const YAML::Node& node) {
  if (!node.IsDefined() || node.Mark().is_null()) {
    return name;
  }
  return name + ":" + std::to_string(node.Mark().line + 1);
}

std::string yamlExcerpt(const YAML::Node& node) {
  YAML::Emitter emitter;
  emitter.SetSeqFormat(YAML::Flow);
  emitter.SetMapFormat(YAML::Flow);
  emitter << node;
  std::string text = emitter.c_str();
  text = text.substr(0, text.find('\n'));
  return text.size() <= kMaxExcerpt ? text : text.substr(0, kMaxExcerpt) + "...";
}

}  // namespace tartan_calib::io
