#include "tartan_calib/guidance/overlay.h"

#include "painter.h"
#include "tartan_calib/text.h"

namespace tartan_calib::guidance {
namespace {

constexpr double kFullHeat = 20.0;  ///< corners in a cell: more make no difference to a calibration
constexpr double kOutlineWidth_px = 4.0;

}  // namespace

cv::Mat drawOverlay(const cv::Mat& gray, const Overlay& overlay, int max_width) {
  Painter painter(gray, max_width);
  if (overlay.coverage != nullptr) {
    const cv::Mat1i& counts = overlay.coverage->counts();
    cv::Mat1f levels;
    counts.convertTo(levels, CV_32F, 1.0 / kFullHeat);
    painter.drawHeat(levels, counts > 0);
  }
  for (const std::vector<Eigen::Vector2d>& line : overlay.outline) {
    painter.drawLine(line, kOutlineWidth_px, kVermillion);
  }
  for (const observation::Corner& corner : overlay.corners) {
    painter.drawRing(corner.px, kSkyBlue);
  }
  if (!overlay.warning.empty()) {
    painter.drawHeadline(overlay.warning, kLargeText, kYellow);
  }
  painter.addBand(overlay.advice, kLargeText, kWhite);
  painter.addBandWithScale(overlay.status, areaColours, format("%.0f+ corners", kFullHeat));
  return painter.picture();
}

}  // namespace tartan_calib::guidance
