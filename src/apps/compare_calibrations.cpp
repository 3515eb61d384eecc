#include "compare_calibrations/comparison.h"

#include <iostream>

#include "common/command_line.h"
#include "common/interrupt.h"
#include "common/picture_file.h"
#include "common/program.h"
#include "compare_calibrations/difference_map.h"
#include "tartan_calib/io/corners_csv.h"

namespace {

namespace po = boost::program_options;
using namespace tartan_calib;
using namespace tartan_calib::apps;

constexpr const char* kHelp = R"(Compares two calibrations of the same cameras.

  rosrun tartan_calib compare_calibrations rig-camchain.yaml other-camchain.yaml --output difference.png

Parameters make up for each other (the scale and the shape of a lens, above all), so what counts is where the two send the same
ray: the difference of the projections over the image, with the rotation between the two camera frames removed. The models of a
camera may differ. Extrinsics are compared where both files have them, for every two cameras.

  --max-angle-deg A      look at rays to this angle from the axis (90)
  --distance M           compare for points so many metres away, a translation removed too (infinity)
  --corners F [F ...]    only where all these recordings (files of --export-corners) have corners
  --output F.png         also draw the differences over the image of every camera
  -h, --help             this text
)";

constexpr double kDefaultMaxAngle_deg = 90.0;
constexpr double kRadiansPerDegree = 0.017453292519943295;

po::variables_map parse(const std::vector<std::string>& words) {
  po::options_description options;
  options.add_options()("help,h", "")("max-angle-deg", po::value<double>()->default_value(kDefaultMaxAngle_deg));
  options.add_options()("distance", po::value<double>());
  options.add_options()("corners", po::value<std::vector<std::string>>()->multitoken());
  options.add_options()("output", po::value<std::string>());
  options.add_options()("camchain", po::value<std::vector<std::string>>());
  po::positional_options_description files;
  files.add("camchain", -1);
  return parseCommandLine(words, options, files);
}

ComparisonRegion regionFrom(const po::variables_map& values) {
  ComparisonRegion region;
  const double max_angle_deg = values["max-angle-deg"].as<double>();
  if (!(max_angle_deg > 0.0)) {
    throw UsageError("--max-angle-deg must be a positive number of degrees");
  }
  region.max_angle_rad = max_angle_deg * kRadiansPerDegree;
  if (values.count("distance") > 0) {
    region.distance_m = values["distance"].as<double>();
    if (!(*region.distance_m > 0.0)) {
      throw UsageError("--distance must be a positive number of metres");
    }
  }
  if (values.count("corners") > 0) {
    for (const std::string& file : values["corners"].as<std::vector<std::string>>()) {
      region.recordings.push_back(io::loadCorners(file));
    }
  }
  return region;
}

int run(const std::vector<std::string>& words) {
  const po::variables_map values = parse(words);
  if (const std::optional<int> exit_code = answerHelp(words, values, kHelp)) {
    return *exit_code;
  }
  const auto files =
      values.count("camchain") > 0 ? values["camchain"].as<std::vector<std::string>>() : std::vector<std::string>{};
  if (files.size() != 2) {
    throw UsageError("two camchain files are needed; see --help");
  }
  const auto picture = values.count("output") > 0 ? values["output"].as<std::string>() : std::string();
  if (!picture.empty()) {
    checkPngName(picture);
  }
  const ComparisonRegion region = regionFrom(values);
  const io::Camchain a = io::loadCamchain(files[0], io::Extrinsics::kOptional);
  const io::Camchain b = io::loadCamchain(files[1], io::Extrinsics::kOptional);
  const RigComparison comparison = compareRigs(a.rig, b.rig, region);
  std::cout << comparisonText(a, b, region, comparison);
  if (!picture.empty()) {
    savePng(picture, differenceMap(a, b, region, comparison));
    std::cout << "Map written to " << picture << '\n';
  }
  return kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  installInterruptHandler();
  return runProgram(argc, argv, run);
}
