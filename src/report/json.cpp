#include "json.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace tartan_calib::report {

std::string json(double value) {
  if (!std::isfinite(value)) {
    return "null";
  }
  constexpr std::size_t kLongestNumber = 32;
  std::array<char, kLongestNumber> text{};
  std::snprintf(text.data(), text.size(), "%.12g", value);
  return text.data();
}

std::string json(const std::optional<double>& value) { return value ? json(*value) : "null"; }

std::string json(const std::string& value) {
  constexpr unsigned char kFirstPrintable = 0x20;
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') {
      text += '\\';
      text += c;
    } else if (static_cast<unsigned char>(c) < kFirstPrintable) {
      std::array<char, 8> escape{};
      std::snprintf(escape.data(), escape.size(), "\\u%04x", static_cast<unsigned>(c));
      text += escape.data();
    } else {
      text += c;
    }
  }
  return text + "\"";
}

std::string json(const Eigen::MatrixXd& rows) {
  std::vector<std::string> lines;
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    std::vector<std::string> numbers;
    for (Eigen::Index col = 0; col < rows.cols(); ++col) {
      numbers.push_back(json(rows(row, col)));
    }
    lines.push_back(jsonList(numbers));
  }
  return jsonList(lines);
}

std::string jsonList(const std::vector<std::string>& items) {
  std::string text = "[";
  for (const std::string& item : items) {
    text += (text.size() > 1 ? ", " : "") + item;
  }
  return text + "]";
}

}  // namespace tartan_calib::report
