#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tartan_calib::io {

/// Block YAML, line by line. Values come as YAML text: see number_text.h.
class YamlWriter {
 public:
  void add(const std::string& key, const std::string& yaml) { addLine(key + ": " + yaml); }

  /// An entry of a list.
  void item(const std::string& yaml) { addLine("- " + yaml); }

  void comment(const std::string& text) { addLine("# " + text); }

  /// What follows belongs to `key`, until close().
  void open(const std::string& key) {
    addLine(key + ":");
    ++depth_;
  }
  void close() { --depth_; }

  const std::string& text() const { return text_; }

 private:
  void addLine(const std::string& line) { text_ += std::string(2 * depth_, ' ') + line + "\n"; }

  std::string text_;
  std::size_t depth_ = 0;
};

}  // namespace tartan_calib::io
