#include <algorithm>
#include <cmath>
#include <vector>

#include "number_text.h"
#include "tartan_calib/io/results_text.h"

namespace tartan_calib::io {
namespace {

constexpr int kPrecision = 8;              ///< numpy's default number of decimals
constexpr std::size_t kElementWidth = 74;  ///< numpy's line of 75, less the closing bracket

/// numpy's dragon4_positional(precision=8, trim='.'): as few decimals as the number needs, at most 8, the point stays.
std::string positional(double value) {
  if (!std::isfinite(value)) {
    return pythonFloat(value);
  }
  const std::string shortest = pythonFloat(value);
  const std::size_t point = shortest.find('.');
  const bool is_short = shortest.find('e') == std::string::npos && shortest.size() - point - 1 <= kPrecision;
  const std::string text = is_short ? shortest : fixedText(value, kPrecision);
  return text.substr(0, text.find_last_not_of('0') + 1);
}

/// Texts of equal width: points below each other, blanks instead of trailing zeros.
std::vector<std::string> columns(const Eigen::MatrixXd& values) {
  std::vector<std::string> texts;
  std::size_t left = 0;
  std::size_t right = 0;
  std::size_t width = 0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    texts.push_back(positional(values(i)));
    const std::size_t point = texts.back().find('.');
    if (point != std::string::npos) {
      left = std::max(left, point);
      right = std::max(right, texts.back().size() - point - 1);
    } else {
      width = std::max(width, texts.back().size());
    }
  }
  width = std::max(width, left + 1 + right);
  for (std::string& text : texts) {
    const std::size_t point = text.find('.');
    const std::size_t after = point == std::string::npos ? 0 : right - (text.size() - point - 1);
    text.append(after, ' ');
    text.insert(0, width - text.size(), ' ');
  }
  return texts;
}

/// `[a b c]`, wrapped as numpy wraps: continuation lines start with `indent`, trailing blanks before a line's end are
/// dropped.
std::string bracketed(const std::vector<std::string>& texts, const std::string& indent) {
  std::string done;
  std::string line = indent;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (line.size() + texts[i].size() > kElementWidth && line.size() > indent.size()) {
      done += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
      line = indent;
    }
    line += texts[i] + (i + 1 < texts.size() ? " " : "");
  }
  return "[" + (done + line).substr(indent.size()) + "]";
}

}  // namespace

std::string arrayText(const Eigen::VectorXd& values) { return bracketed(columns(values), " "); }

std::string matrixText(const Eigen::MatrixXd& values) {
  const std::vector<std::string> texts = columns(values);  // column by column, as Eigen stores it
  std::string rows;
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    std::vector<std::string> row_texts;
    for (Eigen::Index col = 0; col < values.cols(); ++col) {
      row_texts.push_back(texts[static_cast<std::size_t>(col * values.rows() + row)]);
    }
    rows += (row > 0 ? "\n " : "") + bracketed(row_texts, "  ");
  }
  return "[" + rows + "]";
}

}  // namespace tartan_calib::io
