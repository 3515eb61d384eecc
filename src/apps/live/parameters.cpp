#include "live/parameters.h"

#include <sstream>

#include "common/program.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

std::vector<std::string> split(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  return words;
}

}  // namespace

std::string Parameters::text(const std::string& name, const std::string& fallback) {
  known_.insert(node_.resolveName(name));
  std::string value = fallback;
  if (node_.hasParam(name) && !node_.getParam(name, value)) {
    throw UsageError("parameter ~" + name + " must be a text");
  }
  return value;
}

std::string Parameters::text(const std::string& name) {
  std::string value = text(name, "");
  if (value.empty()) {
    throw UsageError("parameter ~" + name + " is missing");
  }
  return value;
}

std::vector<std::string> Parameters::words(const std::string& name, const std::vector<std::string>& fallback) {
  known_.insert(node_.resolveName(name));
  std::vector<std::string> list;
  std::string text;
  if (node_.hasParam(name) && !node_.getParam(name, list)) {
    if (!node_.getParam(name, text)) {
      throw UsageError("parameter ~" + name + " must be a list of texts, or one text with blanks between them");
    }
    list = split(text);
  }
  return list.empty() ? fallback : list;
}

std::vector<std::string> Parameters::words(const std::string& name) {
  std::vector<std::string> list = words(name, {});
  if (list.empty()) {
    throw UsageError("parameter ~" + name + " is missing");
  }
  return list;
}

double Parameters::number(const std::string& name, double fallback, double lowest, double highest) {
  known_.insert(node_.resolveName(name));
  double value = fallback;
  if (node_.hasParam(name) && !node_.getParam(name, value)) {
    throw UsageError("parameter ~" + name + " must be a number");
  }
  if (!(value >= lowest && value <= highest)) {
    throw UsageError(format("parameter ~%s must be from %g to %g", name.c_str(), lowest, highest));
  }
  return value;
}

void Parameters::checkAllKnown() const {
  std::vector<std::string> names;
  node_.getParamNames(names);
  const std::string prefix = node_.getNamespace() + "/";
  for (const std::string& name : names) {
    if (name.compare(0, prefix.size(), prefix) == 0 && known_.count(name) == 0) {
      throw UsageError("unknown parameter " + name);
    }
  }
}

}  // namespace tartan_calib::apps
