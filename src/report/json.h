#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace tartan_calib::report {

/// JSON text of a value; not finite and absent numbers become null.
std::string json(double value);
std::string json(const std::optional<double>& value);
std::string json(const std::string& value);
std::string json(const Eigen::MatrixXd& rows);

inline std::string json(const char* value) { return json(std::string(value)); }
inline std::string json(int value) { return std::to_string(value); }

/// `[a, b]` of texts that are JSON already.
std::string jsonList(const std::vector<std::string>& items);

/// A list of json(convert(item)).
template <class Items, class Convert>
std::string jsonListOf(const Items& items, const Convert& convert) {
  std::vector<std::string> texts;
  for (const auto& item : items) {
    texts.push_back(convert(item));
  }
  return jsonList(texts);
}

inline std::string json(const std::vector<std::string>& items) {
  return jsonListOf(items, [](const std::string& item) { return json(item); });
}

/// `{"key": value, ...}` in the order of the calls.
class JsonObject {
 public:
  template <class Value>
  JsonObject& add(const std::string& key, const Value& value) {
    return addText(key, json(value));
  }

  /// `text` is JSON already.
  JsonObject& addText(const std::string& key, const std::string& text) {
    text_ += (text_.empty() ? "" : ", ") + json(key) + ": " + text;
    return *this;
  }

  std::string text() const { return "{" + text_ + "}"; }

 private:
  std::string text_;
};

}  // namespace tartan_calib::report
