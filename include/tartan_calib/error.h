#pragma once

#include <stdexcept>
#include <string>

namespace tartan_calib {

/// Base of everything this library throws. The message is one line: what is wrong, where, and what to do about it.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file, flag or recording that cannot be used as it is.
class InputError : public Error {
 public:
  using Error::Error;
};

/// The data was readable but does not determine a calibration (too few views, unconnected cameras, no convergence).
class CalibrationError : public Error {
 public:
  using Error::Error;
};

}  // namespace tartan_calib
