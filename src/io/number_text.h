#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tartan_calib::io {

/// The shortest decimal that reads back as the same double, laid out as Python's repr: 0.1, 1e-05, 1e+16, -0.0, inf, nan.
std::string pythonFloat(double value);

/// pythonFloat as PyYAML writes it, always readable as a float of YAML 1.1: 1.0e-05, .inf, .nan.
std::string yamlFloat(double value);

/// printf's `%.*f`.
std::string fixedText(double value, int decimals);

/// `[1.0, 2.5]`
std::string yamlFlow(const Eigen::VectorXd& values);
std::string yamlFlow(const std::vector<int>& values);
std::string yamlFlow(const std::vector<std::string>& values);

/// Plain where YAML 1.1 reads the plain text as that string, single-quoted otherwise, double-quoted with escapes where there
/// are control characters.
std::string yamlString(const std::string& text);

}  // namespace tartan_calib::io
