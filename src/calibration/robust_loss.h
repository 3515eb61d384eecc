#pragma once

#include <cmath>

namespace tartan_calib::calibration {

/// What a corner costs by its squared whitened residual s: cost = rho(s) / 2, weight = rho'(s).
struct RobustLoss {
  enum class Kind {
    kLeastSquares,    ///< rho = s
    kCauchy,          ///< rho = w^2 log(1 + s / w^2)
    kBlakeZisserman,  ///< rho = -log(exp(-s) + epsilon): Kalibr's weight exp(-s) / (exp(-s) + epsilon)
  };

  Kind kind = Kind::kLeastSquares;
  double width = 1.0;  ///< w

  double rho(double s) const {
    switch (kind) {
      case Kind::kCauchy:
        return width * width * std::log1p(s / (width * width));
      case Kind::kBlakeZisserman:
        return -std::log((std::exp(-s) + kEpsilon) / (1.0 + kEpsilon));
      case Kind::kLeastSquares:
        break;
    }
    return s;
  }

  double weight(double s) const {
    switch (kind) {
      case Kind::kCauchy:
        return 1.0 / (1.0 + s / (width * width));
      case Kind::kBlakeZisserman:
        return 1.0 / (1.0 + kEpsilon * std::exp(std::fmin(s, kMaxExponent)));
      case Kind::kLeastSquares:
        break;
    }
    return 1.0;
  }

  /// Kalibr's: weight 0.1 at the 99.9 % quantile of chi-square with 2 degrees of freedom, 9 exp(-13.816).
  static constexpr double kEpsilon = 9.0e-6;

 private:
  static constexpr double kMaxExponent = 700.0;  ///< exp() overflows at 709
};

}  // namespace tartan_calib::calibration
