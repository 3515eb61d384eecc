#include "number_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>

namespace tartan_calib::io {
namespace {

constexpr int kMinDigits = 15;  ///< every decimal of so few digits survives the way through a double
constexpr int kMaxDigits = 17;  ///< every double survives the way through a decimal of so many digits

/// Exponents (of the first digit) between which Python's repr needs no `e`.
constexpr int kMinFixedExponent = -4;
constexpr int kMaxFixedExponent = 15;

/// |value| = 0.d1d2d3... * 10^(exponent + 1), shortest.
struct Decimal {
  std::string digits;
  int exponent = 0;
};

Decimal shortestDecimal(double magnitude) {
  std::array<char, 32> text{};
  for (int digits = kMinDigits; digits <= kMaxDigits; ++digits) {
    std::snprintf(text.data(), text.size(), "%.*e", digits - 1, magnitude);
    if (std::strtod(text.data(), nullptr) == magnitude) {
      break;
    }
  }
  const std::string scientific(text.data());
  const std::size_t e = scientific.find('e');
  Decimal decimal;
  decimal.exponent = std::atoi(scientific.c_str() + e + 1);
  decimal.digits = scientific.substr(0, 1) + scientific.substr(2, e - 2);
  const std::size_t last = decimal.digits.find_last_not_of('0');
  decimal.digits.resize(last == std::string::npos ? 1 : last + 1);
  return decimal;
}

std::string fixedLayout(const Decimal& decimal) {
  if (decimal.exponent < 0) {
    return "0." + std::string(static_cast<std::size_t>(-decimal.exponent) - 1, '0') + decimal.digits;
  }
  std::string digits = decimal.digits;
  const std::size_t integer_digits = static_cast<std::size_t>(decimal.exponent) + 1;
  if (digits.size() <= integer_digits) {
    digits.append(integer_digits - digits.size(), '0');
    return digits + ".0";
  }
  return digits.insert(integer_digits, ".");
}

std::string exponentLayout(const Decimal& decimal) {
  std::string text = decimal.digits;
  if (text.size() > 1) {
    text.insert(1, ".");
  }
  std::array<char, 8> exponent{};
  std::snprintf(exponent.data(), exponent.size(), "e%+03d", decimal.exponent);
  return text + exponent.data();
}

/// Words that YAML 1.1 does not read as strings, in lower case.
bool isReservedWord(const std::string& text) {
  static const std::set<std::string> words = {"", "~", "null", "true", "false", "yes", "no", "on", "off", "y", "n"};
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return words.count(lower) > 0;
}

bool isPlainSafe(const std::string& text) {
  const auto is_safe = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '/' || c == '.' || c == '-'; };
  const bool starts_safe = !text.empty() && (std::isalpha(static_cast<unsigned char>(text[0])) != 0 || text[0] == '/');
  return starts_safe && !isReservedWord(text) && std::all_of(text.begin(), text.end(), is_safe);
}

std::string doubleQuoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    std::array<char, 8> escape{};
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) {
      std::snprintf(escape.data(), escape.size(), "\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(c)));
      quoted += escape.data();
    } else {
      quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    }
  }
  return quoted + "\"";
}

template <typename Values, typename Text>
std::string flow(const Values& values, const Text& text) {
  std::string list = "[";
  for (auto i = values.size() * 0; i < values.size(); ++i) {
    list += (i > 0 ? ", " : "") + text(values[i]);
  }
  return list + "]";
}

}  // namespace

std::string pythonFloat(double value) {
  if (std::isnan(value)) {
    return "nan";
  }
  const std::string sign = std::signbit(value) ? "-" : "";
  if (std::isinf(value)) {
    return sign + "inf";
  }
  const Decimal decimal = shortestDecimal(std::abs(value));
  const bool is_fixed = decimal.exponent >= kMinFixedExponent && decimal.exponent <= kMaxFixedExponent;
  return sign + (is_fixed ? fixedLayout(decimal) : exponentLayout(decimal));
}

std::string yamlFloat(double value) {
  std::string text = pythonFloat(value);
  if (!std::isfinite(value)) {
    return text.insert(text[0] == '-' ? 1 : 0, ".");
  }
  const std::size_t e = text.find('e');
  if (e != std::string::npos && text.find('.') == std::string::npos) {
    text.insert(e, ".0");
  }
  return text;
}

std::string fixedText(double value, int decimals) {
  const int length = std::snprintf(nullptr, 0, "%.*f", decimals, value);
  std::string text(static_cast<std::size_t>(length) + 1, '\0');
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  text.pop_back();
  return text;
}

std::string yamlFlow(const Eigen::VectorXd& values) { return flow(values, yamlFloat); }

std::string yamlFlow(const std::vector<int>& values) {
  return flow(values, [](int value) { return std::to_string(value); });
}

std::string yamlFlow(const std::vector<std::string>& values) { return flow(values, yamlString); }

std::string yamlString(const std::string& text) {
  if (isPlainSafe(text)) {
    return text;
  }
  const auto is_control = [](unsigned char c) { return std::iscntrl(c) != 0; };
  if (std::any_of(text.begin(), text.end(), is_control)) {
    return doubleQuoted(text);
  }
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? "''" : std::string(1, c);
  }
  return quoted + "'";
}

}  // namespace tartan_calib::io
