#pragma once

#include <Eigen/Core>
#include <string>

#include "create_target/artwork.h"

namespace tartan_calib::apps {

/// A sheet of paper with a board in the middle and, below it, a ruler and the board in words. Millimetres to the right and
/// down from the upper left corner of the paper.
struct Sheet {
  std::string paper;  ///< its name and size, for people
  Eigen::Vector2d size_mm = Eigen::Vector2d::Zero();
  Artwork artwork;
  Eigen::Vector2d artwork_mm = Eigen::Vector2d::Zero();  ///< where the upper left corner of the artwork is
  Eigen::Vector2d ruler_mm = Eigen::Vector2d::Zero();    ///< left end of the ruler
};

constexpr double kRulerLength_mm = 100.0;

/// `paper`: A4 to A0, letter, or WIDTHxHEIGHT in millimetres; turned where the board fits only then. Empty: the smallest of
/// A4 to A0 on which the board fits, beyond that paper cut to the board. Throws InputError that says the sizes where the
/// board does not fit.
Sheet layOut(const Artwork& artwork, const std::string& paper);

}  // namespace tartan_calib::apps
