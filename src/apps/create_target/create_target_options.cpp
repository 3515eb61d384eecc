#include <boost/program_options.hpp>
#include <cmath>
#include <map>

#include "common/program.h"
#include "common/recording.h"
#include "create_target/create_target.h"
#include "tartan_calib/target/tag_family.h"

namespace tartan_calib::apps {
namespace {

namespace po = boost::program_options;

constexpr const char* kHelp = R"(Makes a calibration board to print, and the file that describes it.

  rosrun tartan_calib create_target board --type apriltag --nx 6 --ny 6 --tsize 0.023 --tspace 0.3

writes board.pdf, a page of A4 at true scale with a ruler to check the print, and board.yaml for --target of
calibrate_cameras. Flags have the names and defaults of kalibr_create_target_pdf's.

  output              name of the files, without extension (target)
  --type T            apriltag (or aprilgrid), checkerboard, circlegrid (apriltag)
  --nx N, --ny N      columns and rows: of tags, of inner corners, of circles (6, 7)
AprilGrid
  --tsize M           outer side of a tag's black square [m] (0.08)
  --tspace RATIO      gap between tags / tsize (0.3)
  --tfam F            t36h11, t36h10, t25h9, t16h5 (t36h11)
  --tborder N         width of the black border: 2 cells as Kalibr prints it, 1 as stock AprilTag does (2)
  --first-id N        id of the tag at the lower left (0)
Checkerboard
  --csx M, --csy M    width and height of a square [m] (0.05)
Circle grid
  --spacing M         between the centres of neighbouring circles; of rows, where the grid is asymmetric [m] (0.02)
  --asymmetric        every other row is shifted by the spacing, circles within a row are two of it apart
Any
  --target T.yaml     the board of this file, instead of all flags above but the output's name
  --page P            A4, A3, A2, A1, A0, letter, or WIDTHxHEIGHT in mm (the smallest of A4 to A0 that fits)
  --dpi N             also a PNG of so many pixels per inch
  -h, --help          this text
)";

/// Flags that describe a board, and the type of board that has them.
const std::map<std::string, std::string>& boardFlags() {
  static const std::map<std::string, std::string> flags = {
      {"tsize", "apriltag"},   {"tspace", "apriltag"},    {"tfam", "apriltag"},
      {"tborder", "apriltag"}, {"first-id", "apriltag"},  {"csx", "checkerboard"},
      {"csy", "checkerboard"}, {"spacing", "circlegrid"}, {"asymmetric", "circlegrid"}};
  return flags;
}

po::variables_map parse(const std::vector<std::string>& arguments) {
  po::options_description options;
  options.add_options()("help,h", "")("output", po::value<std::string>()->default_value("target"), "");
  options.add_options()("type", po::value<std::string>()->default_value("apriltag"), "");
  options.add_options()("nx", po::value<int>()->default_value(6), "")("ny", po::value<int>()->default_value(7), "");
  options.add_options()("tsize", po::value<double>()->default_value(0.08), "");
  options.add_options()("tspace", po::value<double>()->default_value(0.3), "");
  options.add_options()("tfam", po::value<std::string>()->default_value("t36h11"), "");
  options.add_options()("tborder", po::value<int>()->default_value(2), "");
  options.add_options()("first-id", po::value<int>()->default_value(0), "");
  options.add_options()("csx", po::value<double>()->default_value(0.05), "");
  options.add_options()("csy", po::value<double>()->default_value(0.05), "");
  options.add_options()("spacing", po::value<double>()->default_value(0.02), "")("asymmetric", "");
  options.add_options()("target", po::value<std::string>(), "")("page", po::value<std::string>(), "");
  options.add_options()("dpi", po::value<double>(), "");
  po::positional_options_description output;
  output.add("output", 1);
  po::variables_map values;
  try {
    po::store(po::command_line_parser(arguments).options(options).positional(output).run(), values);
  } catch (const po::error& error) {
    throw UsageError(std::string(error.what()) + "; see --help");
  }
  return values;
}

bool isGiven(const po::variables_map& values, const std::string& flag) {
  return values.count(flag) > 0 && !values[flag].defaulted();
}

int intBetween(const po::variables_map& values, const std::string& flag, int min, int max) {
  const int value = values[flag].as<int>();
  if (value < min || value > max) {
    throw UsageError("--" + flag + " must be from " + std::to_string(min) + " to " + std::to_string(max) + ", not " +
                     std::to_string(value));
  }
  return value;
}

double positive(const po::variables_map& values, const std::string& flag) {
  const double value = values[flag].as<double>();
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw UsageError("--" + flag + " must be a positive number");
  }
  return value;
}

std::string typeOf(const po::variables_map& values) {
  auto type = values["type"].as<std::string>();
  if (type == "apriltag" || type == "aprilgrid") {
    return "apriltag";
  }
  if (type == "checkerboard" || type == "circlegrid") {
    return type;
  }
  throw UsageError("--type " + type + " is unknown: choose apriltag, checkerboard or circlegrid");
}

target::Target boardOf(const po::variables_map& values) {
  constexpr int kMinGrid = 3;  // what Kalibr's YAML allows
  constexpr int kMaxGrid = 1000;
  const std::string type = typeOf(values);
  for (const auto& [flag, owner] : boardFlags()) {
    if (owner != type && isGiven(values, flag)) {
      throw UsageError("--" + flag + " belongs to --type " + owner + ", but the type is " + type);
    }
  }
  const int cols = intBetween(values, "nx", kMinGrid, kMaxGrid);
  const int rows = intBetween(values, "ny", kMinGrid, kMaxGrid);
  if (type == "checkerboard") {
    return target::Checkerboard{rows, cols, positive(values, "csy"), positive(values, "csx")};
  }
  if (type == "circlegrid") {
    return target::CircleGrid{rows, cols, positive(values, "spacing"), values.count("asymmetric") > 0};
  }
  target::AprilGrid grid{rows, cols, positive(values, "tsize"), positive(values, "tspace")};
  grid.family = values["tfam"].as<std::string>();
  const int num_codes = static_cast<int>(target::tagFamily(grid.family).codes.size());
  grid.border_cells = intBetween(values, "tborder", 1, 2);
  grid.code_offset = intBetween(values, "first-id", 0, num_codes - 1);
  return grid;
}

target::Target boardOfFile(const po::variables_map& values) {
  for (const std::string flag : {"type", "nx", "ny"}) {
    if (isGiven(values, flag)) {
      throw UsageError("--" + flag + " and --target exclude each other: both describe the board");
    }
  }
  for (const auto& [flag, owner] : boardFlags()) {
    if (isGiven(values, flag)) {
      throw UsageError("--" + flag + " and --target exclude each other: both describe the board");
    }
  }
  return openTarget(values["target"].as<std::string>(), printWarning);
}

/// Without the extension of one of the files that are written.
std::string baseOf(const std::string& output) {
  for (const std::string extension : {".pdf", ".png", ".yaml"}) {
    if (output.size() > extension.size() &&
        output.compare(output.size() - extension.size(), extension.size(), extension) == 0) {
      return output.substr(0, output.size() - extension.size());
    }
  }
  return output;
}

}  // namespace

const char* createTargetHelp() { return kHelp; }

std::optional<CreateTargetOptions> parseCreateTargetOptions(const std::vector<std::string>& arguments) {
  const po::variables_map values = parse(arguments);
  if (values.count("help") > 0) {
    return std::nullopt;
  }
  CreateTargetOptions options;
  options.base = baseOf(values["output"].as<std::string>());
  options.page = values.count("page") > 0 ? values["page"].as<std::string>() : "";
  if (values.count("dpi") > 0) {
    options.dpi = positive(values, "dpi");
  }
  options.target = values.count("target") > 0 ? boardOfFile(values) : boardOf(values);
  return options;
}

}  // namespace tartan_calib::apps
