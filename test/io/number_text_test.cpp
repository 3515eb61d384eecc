#include "../../src/io/number_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

namespace tartan_calib::io {
namespace {

TEST(PythonFloat, IsLaidOutAsRepr) {
  EXPECT_EQ(pythonFloat(0.0), "0.0");
  EXPECT_EQ(pythonFloat(-0.0), "-0.0");
  EXPECT_EQ(pythonFloat(460.0), "460.0");
  EXPECT_EQ(pythonFloat(0.1), "0.1");
  EXPECT_EQ(pythonFloat(0.088 * 0.3), "0.026399999999999996");
  EXPECT_EQ(pythonFloat(-0.21105497295774261), "-0.21105497295774261");
  EXPECT_EQ(pythonFloat(0.0001), "0.0001");
  EXPECT_EQ(pythonFloat(0.00001), "1e-05");
  EXPECT_EQ(pythonFloat(-1.1125061315705107e-05), "-1.1125061315705107e-05");
  EXPECT_EQ(pythonFloat(1e15), "1000000000000000.0");
  EXPECT_EQ(pythonFloat(1e16), "1e+16");
  EXPECT_EQ(pythonFloat(123456789012345680.0), "1.2345678901234568e+17");
  EXPECT_EQ(pythonFloat(1e-300), "1e-300");
  EXPECT_EQ(pythonFloat(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(pythonFloat(-std::numeric_limits<double>::infinity()), "-inf");
}

TEST(PythonFloat, ReadsBackAsTheSameDouble) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = random();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof(value));
    if (std::isfinite(value)) {
      ASSERT_EQ(std::strtod(pythonFloat(value).c_str(), nullptr), value);
    }
  }
}

TEST(YamlFloat, HasAPointForYaml11) {
  EXPECT_EQ(yamlFloat(0.00001), "1.0e-05");
  EXPECT_EQ(yamlFloat(1.5e-05), "1.5e-05");
  EXPECT_EQ(yamlFloat(1e16), "1.0e+16");
  EXPECT_EQ(yamlFloat(2.0), "2.0");
  EXPECT_EQ(yamlFloat(std::numeric_limits<double>::quiet_NaN()), ".nan");
  EXPECT_EQ(yamlFloat(std::numeric_limits<double>::infinity()), ".inf");
  EXPECT_EQ(yamlFloat(-std::numeric_limits<double>::infinity()), "-.inf");
}

TEST(YamlFlow, SeparatesByCommaAndBlank) {
  EXPECT_EQ(yamlFlow(std::vector<int>{}), "[]");
  EXPECT_EQ(yamlFlow(std::vector<int>{640, 480}), "[640, 480]");
  EXPECT_EQ(yamlFlow(Eigen::VectorXd(Eigen::Vector2d(1.0, -2.5e-7))), "[1.0, -2.5e-07]");
  EXPECT_EQ(yamlFlow(std::vector<std::string>{"a b", "c"}), "['a b', c]");
}

TEST(YamlString, IsQuotedWhereYamlWouldReadSomethingElse) {
  EXPECT_EQ(yamlString("/cam0/image_raw"), "/cam0/image_raw");
  EXPECT_EQ(yamlString("cam0"), "cam0");
  EXPECT_EQ(yamlString(""), "''");
  EXPECT_EQ(yamlString("12"), "'12'");
  EXPECT_EQ(yamlString("No"), "'No'");
  EXPECT_EQ(yamlString("it's: #1"), "'it''s: #1'");
  EXPECT_EQ(yamlString("two\nlines \"x\""), "\"two\\x0alines \\\"x\\\"\"");
}

TEST(FixedText, KeepsAllDigitsOfLongNumbers) {
  EXPECT_EQ(fixedText(-0.0000004, 6), "-0.000000");
  EXPECT_EQ(fixedText(1e40, 1).size(), 43U);
}

}  // namespace
}  // namespace tartan_calib::io
