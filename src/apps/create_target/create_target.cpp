#include "create_target/create_target.h"

#include "create_target/drawing.h"
#include "create_target/sheet.h"
#include "tartan_calib/io/atomic_file.h"
#include "tartan_calib/io/target_yaml.h"

namespace tartan_calib::apps {

std::string createTarget(const CreateTargetOptions& options) {
  constexpr double kMmPerInch = 25.4;
  const Sheet sheet = layOut(makeArtwork(options.target), options.page);
  io::AtomicFileSet files;
  files.add(options.base + ".pdf").write(pdfOf(sheet));
  files.add(options.base + ".yaml").write(io::targetText(options.target));
  std::string written = "Wrote " + options.base + ".pdf (" + sheet.paper + ")\n";
  if (options.dpi) {
    const double pixels_per_mm = *options.dpi / kMmPerInch;
    const cv::Mat image = imageOf(sheet, pixels_per_mm);
    files.add(options.base + ".png").write(pngOf(image, pixels_per_mm));
    written +=
        "Wrote " + options.base + ".png (" + std::to_string(image.cols) + " x " + std::to_string(image.rows) + " pixels)\n";
  }
  files.commit();
  return written + "Wrote " + options.base + ".yaml (for --target)\n" + sheet.artwork.caption + '\n';
}

}  // namespace tartan_calib::apps
