#include "create_target/create_target.h"

#include <map>

#include "common/interrupt.h"
#include "create_target/drawing.h"
#include "create_target/sheet.h"
#include "tartan_calib/io/atomic_file.h"
#include "tartan_calib/io/target_yaml.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

void writeTogether(const std::string& base, const std::map<std::string, std::string>& files) {
  const UninterruptedSection section;
  io::AtomicFileSet set;
  for (const auto& [extension, bytes] : files) {
    set.add(base + "." + extension).write(bytes);
  }
  set.commit();
}

}  // namespace

std::string createTarget(const CreateTargetOptions& options) {
  constexpr double kMmPerInch = 25.4;
  const Sheet sheet = layOut(makeArtwork(options.target), options.page);
  std::map<std::string, std::string> files;  // by extension
  files["pdf"] = pdfOf(sheet);
  files["yaml"] = io::targetText(options.target);
  std::string written = "Wrote " + options.base + ".pdf (" + sheet.paper + ")\n";
  if (options.dpi) {
    const double pixels_per_mm = *options.dpi / kMmPerInch;
    const cv::Mat image = imageOf(sheet, pixels_per_mm);
    files["png"] = pngOf(image, pixels_per_mm);
    written += "Wrote " + options.base + format(".png (%d x %d pixels)\n", image.cols, image.rows);
  }
  writeTogether(options.base, files);
  return written + "Wrote " + options.base + ".yaml (for --target)\n" + sheet.artwork.caption + '\n';
}

}  // namespace tartan_calib::apps
