#include "detect_corners/detect_options.h"

#include "common/command_line.h"
#include "common/output.h"
#include "common/program.h"
#include "common/recording.h"

namespace tartan_calib::apps {
namespace {

namespace po = boost::program_options;

constexpr const char* kHelp = R"(Detects the corners of a board in the images of a recording, without calibrating anything.

  rosrun tartan_calib detect_corners --bag rig.bag --target april_6x6.yaml --topics /cam0/image_raw /cam1/image_raw

writes rig-corners.csv beside the bag, which calibrate_cameras --corners reads, and says what was found in each topic.

  --bag B                   ROS 1 bag, or folder with cam0/<stamp in ns>.png (jpg, bmp, pgm)
  --target F                board: YAML as Kalibr's (aprilgrid, checkerboard, circlegrid)
  --topics T [T ...]        image topics; the first is cam0. Of a folder: /cam0/image_raw ...
  --bag-from-to A B         only images from A to B seconds after the topic's first
  --bag-freq HZ             at most so many images per second
  --min-border-distance PX  AprilGrid: tags closer to the edge of the image are dropped (4)
  --threads N               0 uses all cores (0); the result does not depend on it
  --output F.csv            the corners (<bag>-corners.csv)
  --pictures DIR            also draw images with their corners into DIR/cam0/<stamp in ns>.png ...
  --max-pictures N          at most so many, evenly chosen (100)
  -h, --help                this text

Exit code: 0 with corners, 1 where no image shows the board, 2 for a wrong command line.
)";

po::variables_map parse(const std::vector<std::string>& words) {
  const auto text = [] { return po::value<std::string>(); };
  po::options_description options = selectionOptions();
  auto add = options.add_options();
  add("help,h", "");
  add("bag", text());
  add("target", text());
  add("topics", po::value<std::vector<std::string>>()->multitoken());
  add("min-border-distance", po::value<double>());
  add("threads", po::value<int>());
  add("output", text());
  add("pictures", text());
  add("max-pictures", po::value<int>());
  return parseCommandLine(words, options);
}

void check(const DetectOptions& options) {
  if (options.recording.empty() || options.target_file.empty() || options.topics.empty()) {
    throw UsageError("--bag, --target and --topics are needed; see --help");
  }
  if (!(options.min_border_distance_px >= 0.0)) {
    throw UsageError("--min-border-distance must be a number of pixels, not negative");
  }
  if (options.num_threads < 0) {
    throw UsageError("--threads must not be negative; 0 uses all cores");
  }
  if (options.max_pictures < 1) {
    throw UsageError("--max-pictures must be a positive integer");
  }
}

}  // namespace

std::optional<DetectOptions> parseDetectOptions(const std::vector<std::string>& words) {
  const po::variables_map values = parse(words);
  if (values.count("help") > 0) {
    return std::nullopt;
  }
  DetectOptions options;
  options.selection = selectionFrom(values);
  takeValue(values, "bag", options.recording);
  takeValue(values, "target", options.target_file);
  takeValue(values, "topics", options.topics);
  takeValue(values, "min-border-distance", options.min_border_distance_px);
  takeValue(values, "threads", options.num_threads);
  takeValue(values, "pictures", options.picture_folder);
  takeValue(values, "max-pictures", options.max_pictures);
  check(options);
  options.output = recordingPrefix(options.recording) + "-corners.csv";
  takeValue(values, "output", options.output);
  return options;
}

std::string detectHelp() { return kHelp; }

}  // namespace tartan_calib::apps
