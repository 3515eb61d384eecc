#include "validate_calibration/validate_options.h"

#include <cmath>

#include "common/command_line.h"
#include "common/program.h"
#include "common/recording.h"

namespace tartan_calib::apps {
namespace {

namespace po = boost::program_options;

constexpr const char* kHelp = R"(Checks a calibration with a recording that it was not made from.

  rosrun tartan_calib validate_calibration --bag second.bag --camchain rig-camchain.yaml --target april_6x6.yaml --output errors.png

Lenses and extrinsics stay as they are; only the board's pose is estimated, once per moment for all cameras that see it, and once
for each camera alone. Prints how far corners are from where the calibration puts them, by camera and by angle from the axis,
the worst views, and a verdict.

  --bag B                   ROS 1 bag, or folder with cam0/<stamp in ns>.png; best another one than the calibration's
  --camchain F              the calibration
  --target F                board: YAML as Kalibr's (aprilgrid, checkerboard, circlegrid)
  --topics T [T ...]        image topics, one per camera of the camchain (those that it names)
  --corners F               a file of detect_corners instead of images
  --bag-from-to A B         only images from A to B seconds after the topic's first
  --bag-freq HZ             at most so many images per second
  --approx-sync S           largest difference of stamps in one view of a rig, seconds (0.02)
  --expected-px X           rms that would be right (what the calibration left itself, by the -results-cam.txt beside
                            the camchain)
  --threads N               of the detection; 0 uses all cores (0)
  --output F.png            draw the errors, magnified, over each camera's image
  --export F.csv            write every corner with its error
  -h, --help                this text

Exit code: 0 where there is a verdict, whatever it is; 1 where no view can be checked; 2 for a wrong command line.
)";

po::variables_map parse(const std::vector<std::string>& words) {
  const auto text = [] { return po::value<std::string>(); };
  po::options_description options = selectionOptions();
  auto add = options.add_options();
  add("help,h", "");
  for (const char* name : {"bag", "camchain", "target", "corners", "output", "export"}) {
    add(name, text());
  }
  add("topics", po::value<std::vector<std::string>>()->multitoken());
  add("approx-sync", po::value<double>());
  add("expected-px", po::value<double>());
  add("threads", po::value<int>());
  return parseCommandLine(words, options);
}

std::int64_t syncFrom(const po::variables_map& values, std::int64_t fallback_ns) {
  constexpr double kNsPerSecond = 1e9;
  constexpr double kMaxSync_s = 1e6;
  if (values.count("approx-sync") == 0) {
    return fallback_ns;
  }
  const double sync_s = values["approx-sync"].as<double>();
  if (!(sync_s >= 0.0 && sync_s <= kMaxSync_s)) {
    throw UsageError("--approx-sync must be a number of seconds, not negative");
  }
  return std::llround(sync_s * kNsPerSecond);
}

void check(const ValidateOptions& options) {
  if (options.camchain_file.empty() || options.target_file.empty() ||
      options.recording.empty() == options.corners_file.empty()) {
    throw UsageError("--camchain, --target, and one of --bag and --corners are needed; see --help");
  }
  if (options.num_threads < 0) {
    throw UsageError("--threads must not be negative; 0 uses all cores");
  }
  if (options.expected_px && !(*options.expected_px > 0.0)) {
    throw UsageError("--expected-px must be a positive number of pixels");
  }
}

}  // namespace

std::optional<ValidateOptions> parseValidateOptions(const std::vector<std::string>& words) {
  const po::variables_map values = parse(words);
  if (values.count("help") > 0) {
    return std::nullopt;
  }
  ValidateOptions options;
  options.selection = selectionFrom(values);
  takeValue(values, "bag", options.recording);
  takeValue(values, "corners", options.corners_file);
  takeValue(values, "camchain", options.camchain_file);
  takeValue(values, "topics", options.topics);
  takeValue(values, "target", options.target_file);
  takeValue(values, "threads", options.num_threads);
  takeValue(values, "output", options.picture_file);
  takeValue(values, "export", options.errors_file);
  options.approx_sync_ns = syncFrom(values, options.approx_sync_ns);
  if (values.count("expected-px") > 0) {
    options.expected_px = values["expected-px"].as<double>();
  }
  check(options);
  return options;
}

std::string validateHelp() { return kHelp; }

}  // namespace tartan_calib::apps
