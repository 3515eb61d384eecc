#include "create_target/drawing.h"

#include <cairo-pdf.h>

#include <cmath>
#include <memory>
#include <vector>

#include "tartan_calib/error.h"

namespace tartan_calib::apps {
namespace {

using Surface = std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)>;
using Context = std::unique_ptr<cairo_t, void (*)(cairo_t*)>;

constexpr double kPointsPerMm = 72.0 / 25.4;
constexpr double kTextHeight_mm = 3.0;
constexpr double kTextLine_mm = 4.0;

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS) {
    throw InputError(std::string("the board cannot be drawn: ") + cairo_status_to_string(status));
  }
}

/// All black in one path: what touches then has no seam, whoever fills it.
void drawBoard(cairo_t* page, const Sheet& sheet) {
  const Eigen::Vector2d& origin = sheet.artwork_mm;
  for (const BlackRectangle& black : sheet.artwork.rectangles) {
    cairo_rectangle(page, origin.x() + black.corner_mm.x(), origin.y() + black.corner_mm.y(), black.size_mm.x(),
                    black.size_mm.y());
  }
  for (const BlackDisc& black : sheet.artwork.discs) {
    const Eigen::Vector2d centre = origin + black.centre_mm;
    cairo_new_sub_path(page);
    cairo_arc(page, centre.x(), centre.y(), black.radius_mm, 0.0, 2.0 * M_PI);
  }
  cairo_fill(page);
}

void drawText(cairo_t* page, const Eigen::Vector2d& baseline_mm, double max_width_mm, const std::string& text) {
  cairo_set_font_size(page, kTextHeight_mm);
  cairo_text_extents_t extents;
  cairo_text_extents(page, text.c_str(), &extents);
  if (extents.x_advance > max_width_mm) {
    cairo_set_font_size(page, kTextHeight_mm * max_width_mm / extents.x_advance);
  }
  cairo_move_to(page, baseline_mm.x(), baseline_mm.y());
  cairo_show_text(page, text.c_str());
}

/// A tick every 10 mm, long ones at the ends and in the middle, standing on the line.
void drawRuler(cairo_t* page, const Eigen::Vector2d& left_mm) {
  constexpr double kLineWidth_mm = 0.2;
  constexpr double kTickStep_mm = 10.0;
  constexpr int kNumTicks = static_cast<int>(kRulerLength_mm / kTickStep_mm);
  constexpr int kLongTickEvery = kNumTicks / 2;
  constexpr double kTick_mm = 2.0;
  constexpr double kLongTick_mm = 3.5;
  cairo_set_line_width(page, kLineWidth_mm);
  cairo_set_line_cap(page, CAIRO_LINE_CAP_BUTT);
  cairo_move_to(page, left_mm.x(), left_mm.y());
  cairo_rel_line_to(page, kRulerLength_mm, 0.0);
  for (int i = 0; i <= kNumTicks; ++i) {
    cairo_move_to(page, left_mm.x() + i * kTickStep_mm, left_mm.y());
    cairo_rel_line_to(page, 0.0, i % kLongTickEvery == 0 ? -kLongTick_mm : -kTick_mm);
  }
  cairo_stroke(page);
}

/// The surface's unit is `units_per_mm`.
void drawSheet(cairo_surface_t* surface, const Sheet& sheet, double units_per_mm) {
  const Context context(cairo_create(surface), cairo_destroy);
  cairo_t* page = context.get();
  cairo_scale(page, units_per_mm, units_per_mm);
  cairo_set_source_rgb(page, 0.0, 0.0, 0.0);
  drawBoard(page, sheet);
  drawRuler(page, sheet.ruler_mm);
  cairo_select_font_face(page, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  const double text_width_mm = sheet.size_mm.x() - 2.0 * sheet.ruler_mm.x();
  drawText(page, sheet.ruler_mm + Eigen::Vector2d(0.0, kTextLine_mm), text_width_mm,
           "Print at 100 %, without fitting to the page: the ruler must measure 100 mm.");
  drawText(page, sheet.ruler_mm + Eigen::Vector2d(0.0, 2.0 * kTextLine_mm), text_width_mm, sheet.artwork.caption);
  check(cairo_status(page));
}

cairo_status_t append(void* text, const unsigned char* data, unsigned int size) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

std::string pdfOf(const Sheet& sheet) {
  std::string pdf;
  const Eigen::Vector2d size_pt = kPointsPerMm * sheet.size_mm;
  const Surface surface(cairo_pdf_surface_create_for_stream(append, &pdf, size_pt.x(), size_pt.y()), cairo_surface_destroy);
  check(cairo_surface_status(surface.get()));
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, sheet.artwork.caption.c_str());
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");  // not when it was made
  drawSheet(surface.get(), sheet, kPointsPerMm);
  cairo_surface_finish(surface.get());
  check(cairo_surface_status(surface.get()));
  return pdf;
}

cv::Mat imageOf(const Sheet& sheet, double pixels_per_mm) {
  constexpr double kMaxSide_px = 32767.0;  // cairo's limit
  const Eigen::Vector2d size_px = pixels_per_mm * sheet.size_mm;
  if (size_px.maxCoeff() > kMaxSide_px) {
    throw InputError("an image of " + std::to_string(std::lround(size_px.x())) + " x " +
                     std::to_string(std::lround(size_px.y())) +
                     " pixels is too large: choose a smaller --dpi; the PDF needs none");
  }
  const auto width = static_cast<int>(std::lround(size_px.x()));
  const auto height = static_cast<int>(std::lround(size_px.y()));
  const int stride = cairo_format_stride_for_width(CAIRO_FORMAT_A8, width);
  cv::Mat ink(height, stride, CV_8UC1, cv::Scalar(0));
  const Surface surface(cairo_image_surface_create_for_data(ink.data, CAIRO_FORMAT_A8, width, height, stride),
                        cairo_surface_destroy);
  check(cairo_surface_status(surface.get()));
  drawSheet(surface.get(), sheet, pixels_per_mm);
  cairo_surface_flush(surface.get());
  constexpr double kWhite = 255.0;
  return kWhite - ink.colRange(0, width);
}

}  // namespace tartan_calib::apps
