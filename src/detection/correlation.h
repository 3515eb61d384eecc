#pragma once

#include <cmath>

namespace tartan_calib::detection {

/// Pearson's correlation of pairs (x, y), and the slope of the line that fits y to x.
class Correlation {
 public:
  void add(double x, double y) {
    count_ += 1.0;
    x_ += x;
    y_ += y;
    xx_ += x * x;
    yy_ += y * y;
    xy_ += x * y;
  }
  double count() const { return count_; }

  /// -1 ... 1; 0 where one of the two does not vary.
  double value() const {
    const double product = (count_ * xx_ - x_ * x_) * (count_ * yy_ - y_ * y_);
    return product > 0.0 ? (count_ * xy_ - x_ * y_) / std::sqrt(product) : 0.0;
  }
  double slope() const {
    const double variation = count_ * xx_ - x_ * x_;
    return variation > 0.0 ? (count_ * xy_ - x_ * y_) / variation : 0.0;
  }

 private:
  double count_ = 0.0;
  double x_ = 0.0;
  double y_ = 0.0;
  double xx_ = 0.0;
  double yy_ = 0.0;
  double xy_ = 0.0;
};

}  // namespace tartan_calib::detection
