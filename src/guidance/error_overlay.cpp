#include "tartan_calib/guidance/error_overlay.h"

#include "painter.h"
#include "tartan_calib/text.h"

namespace tartan_calib::guidance {

cv::Mat drawErrors(const cv::Mat& gray, const ErrorOverlay& overlay, int max_width) {
  constexpr double kLineWidth_px = 3.0;
  Painter painter(gray, max_width);
  if (overlay.errors != nullptr) {
    for (const calibration::CornerError& corner : overlay.errors->corners) {
      if (corner.is_wrong) {
        painter.drawCross(corner.px, kVermillion);
        continue;
      }
      const cv::Scalar colour = colourOf(lineColours, corner.error_px.norm() / overlay.full_scale_px);
      painter.drawLine({corner.px, corner.px + overlay.magnification * corner.error_px}, kLineWidth_px, colour);
    }
  }
  painter.addBand(overlay.headline, kLargeText, kWhite);
  painter.addBandWithScale(overlay.status + format(", errors x%.0f", overlay.magnification), lineColours,
                           format("%g px", overlay.full_scale_px));
  return painter.picture();
}

}  // namespace tartan_calib::guidance
