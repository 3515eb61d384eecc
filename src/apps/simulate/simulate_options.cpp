#include "simulate/simulate_options.h"

#include <boost/program_options.hpp>
#include <cmath>
#include <map>
#include <regex>

#include "common/program.h"

namespace tartan_calib::apps {
namespace {

namespace po = boost::program_options;

constexpr const char* kHelp = R"(Renders a recording of a calibration board, with the truth about everything in it.

  rosrun tartan_calib simulate --preset sample --output-bag sample.bag

writes sample.bag and, beside it, sample-target.yaml, sample-truth-camchain.yaml, sample-truth-poses.csv (T_target_cam0 as
Kalibr's --export-poses) and sample-truth-corners.csv: every corner within the image; used = 1 where it is visible, that is
2 px inside of the image and of the lens' circle and 6 px from the hand; cov_* is the Cramer-Rao bound of the pixels around it.
sample-truth-visibility.csv says the same in words: visible; hidden by the hand or outside of the lens' circle; or near one of
these or the image's border, so that it may be seen or not. Beside it the distance to the nearest other corner of the board.

  --preset P        options for a purpose; those given beside it win
                      sample   2 cameras of 190 degrees, 1000x800, 60 views, some with motion blur or a hand
                      bf5m     lens like a Lensagon BF5M, 195 degrees, 1224x1024; 100 views, 1/3 with motion blur, 30 % with a hand
                      gopro    lens like a GoPro Hero 8, 150 degrees, 1280x960; views as bf5m
Output (one of the two)
  --output-bag B    ROS bag with mono8 images on /cam0/image_raw, ...
  --output-dir D    folder in kalibr_bagcreater's layout: D/cam0/<stamp_ns>.png, ...; must not exist
Cameras
  --lens L          fisheye<degrees> (190), pinhole<degrees>, bf5m195, gopro150
  --models M ...    models that take the lens' shape and are the truth: one for all cameras or one each (ds-none)
  --resolution WxH  the lens' own where not given
  --cameras N       (1)
  --baseline M      [m] from one camera to the next on its right (0.12)
  --yaw DEG         of each camera against the one before, to the right (0)
  --delay MS        of each camera against the one before, in when it sees the board; the stamps do not tell (0)
Views
  --target T.yaml   aprilgrid or checkerboard (Kalibr's 6x6 AprilGrid, tags of 0.088 m)
  --views N         (60)
  --rate HZ         (4)
  --reach RATIO     how far the board's centre goes, from the axis (0) to the rim of the image (0.95)
  --tilt DEG        of the board about each of its axes, at most (43)
  --blurred RATIO   part of the views with motion blur (0)
  --motion-blur PX  longest of it, as the mean way of the corners in the image; single corners move farther (8)
  --hands RATIO     part of the views with a hand before the board (0)
  --exposure RATIO  above 1 white paper is cut off at 255 (1)
  --psf PX          standard deviation of the lens' blur (0.6)
  --noise GREY      standard deviation of the noise at half of full scale, of 255 (2)
  --seed N          another recording of the same kind (1)
Other
  --threads N       0: all cores (0); the result is the same for every number
  -h, --help        this text
)";

const std::map<std::string, SimulateOptions>& presets() {
  static const std::map<std::string, SimulateOptions> presets = [] {
    SimulateOptions sample;
    sample.num_cameras = 2;
    sample.yaw_deg = 8.0;
    sample.blurred_ratio = 0.15;
    sample.max_blur_px = 4.0;
    sample.hand_ratio = 0.15;
    SimulateOptions bf5m;
    bf5m.lens = "bf5m195";
    bf5m.num_views = 100;
    bf5m.blurred_ratio = 1.0 / 3.0;
    bf5m.hand_ratio = 0.3;
    SimulateOptions gopro = bf5m;
    gopro.lens = "gopro150";
    return std::map<std::string, SimulateOptions>{{"sample", sample}, {"bf5m", bf5m}, {"gopro", gopro}};
  }();
  return presets;
}

po::options_description describe() {
  po::options_description options;
  options.add_options()("help,h", "")("preset", po::value<std::string>(), "");
  options.add_options()("output-bag", po::value<std::string>(), "")("output-dir", po::value<std::string>(), "");
  options.add_options()("lens", po::value<std::string>(), "");
  options.add_options()("models", po::value<std::vector<std::string>>()->multitoken(), "");
  options.add_options()("resolution", po::value<std::string>(), "")("cameras", po::value<int>(), "");
  options.add_options()("baseline", po::value<double>(), "")("yaw", po::value<double>(), "");
  options.add_options()("target", po::value<std::string>(), "")("views", po::value<int>(), "");
  options.add_options()("delay", po::value<double>(), "")("reach", po::value<double>(), "");
  options.add_options()("tilt", po::value<double>(), "")("rate", po::value<double>(), "")("blurred", po::value<double>(),
                                                                                          "");
  options.add_options()("motion-blur", po::value<double>(), "")("hands", po::value<double>(), "");
  options.add_options()("exposure", po::value<double>(), "")("psf", po::value<double>(), "")("noise", po::value<double>(),
                                                                                             "");
  options.add_options()("seed", po::value<std::int64_t>(), "")("threads", po::value<int>(), "");
  return options;
}

po::variables_map parseValues(const std::vector<std::string>& arguments) {
  po::variables_map values;
  try {
    const po::positional_options_description no_positional;
    po::store(po::command_line_parser(arguments).options(describe()).positional(no_positional).run(), values);
  } catch (const po::error& error) {
    throw UsageError(std::string(error.what()) + "; see --help");
  }
  return values;
}

SimulateOptions presetOptions(const po::variables_map& values) {
  if (values.count("preset") == 0) {
    return {};
  }
  const auto name = values["preset"].as<std::string>();
  const auto found = presets().find(name);
  if (found == presets().end()) {
    throw UsageError("unknown preset '" + name + "'; there are sample, bf5m and gopro");
  }
  return found->second;
}

void setResolution(const std::string& text, SimulateOptions& options) {
  std::smatch match;
  if (!std::regex_match(text, match, std::regex("([1-9][0-9]{1,4})x([1-9][0-9]{1,4})"))) {
    throw UsageError("--resolution " + text + " is not WIDTHxHEIGHT in pixels, such as 1000x800");
  }
  options.width = std::stoi(match[1]);
  options.height = std::stoi(match[2]);
}

/// Option by option: does the number make sense?
void check(const SimulateOptions& options) {
  const auto require = [](bool is_good, const std::string& message) {
    if (!is_good) {
      throw UsageError(message);
    }
  };
  const auto is_ratio = [](double value) { return value >= 0.0 && value <= 1.0; };
  constexpr int kMaxViews = 1'000'000;
  constexpr int kMaxCameras = 64;
  constexpr double kMaxTilt_deg = 60.0;
  require(options.output_bag.empty() != options.output_dir.empty(), "give --output-bag or --output-dir; see --help");
  require(options.num_views >= 1 && options.num_views <= kMaxViews, "--views must be from 1 to 1000000");
  require(options.num_cameras >= 1 && options.num_cameras <= kMaxCameras, "--cameras must be from 1 to 64");
  require(options.models.size() == 1 || static_cast<int>(options.models.size()) == options.num_cameras,
          "--models needs one model for all cameras or one for each of the " + std::to_string(options.num_cameras));
  require(std::isfinite(options.baseline_m) && std::isfinite(options.yaw_deg), "--baseline and --yaw must be finite");
  require(std::isfinite(options.delay_ms), "--delay must be finite");
  require(is_ratio(options.reach_ratio), "--reach must be from 0 to 1");
  require(!options.tilt_deg || (*options.tilt_deg >= 0.0 && *options.tilt_deg <= kMaxTilt_deg),
          "--tilt must be from 0 to 60 degrees");
  require(options.rate_hz > 0.0 && std::isfinite(options.rate_hz), "--rate must be positive");
  require(is_ratio(options.blurred_ratio), "--blurred must be from 0 to 1");
  require(is_ratio(options.hand_ratio), "--hands must be from 0 to 1");
  require(options.max_blur_px >= 0.0 && options.max_blur_px <= 100.0, "--motion-blur must be from 0 to 100 px");
  require(options.exposure_ratio > 0.0 && options.exposure_ratio <= 100.0, "--exposure must be above 0 and at most 100");
  require(options.psf_sigma_px >= 0.0 && options.psf_sigma_px <= 20.0, "--psf must be from 0 to 20 px");
  require(options.noise_grey >= 0.0 && options.noise_grey <= 255.0, "--noise must be from 0 to 255");
  require(options.num_threads >= 0, "--threads must not be negative");
}

}  // namespace

std::optional<SimulateOptions> parseSimulateOptions(const std::vector<std::string>& arguments) {
  const po::variables_map values = parseValues(arguments);
  if (values.count("help") > 0) {
    return std::nullopt;
  }
  SimulateOptions options = presetOptions(values);
  const auto take = [&values](const char* name, auto& option) {
    if (values.count(name) > 0) {
      option = values[name].as<std::decay_t<decltype(option)>>();
    }
  };
  take("output-bag", options.output_bag);
  take("output-dir", options.output_dir);
  take("lens", options.lens);
  take("models", options.models);
  take("cameras", options.num_cameras);
  take("baseline", options.baseline_m);
  take("yaw", options.yaw_deg);
  take("target", options.target_file);
  take("delay", options.delay_ms);
  take("reach", options.reach_ratio);
  take("views", options.num_views);
  take("rate", options.rate_hz);
  take("blurred", options.blurred_ratio);
  take("motion-blur", options.max_blur_px);
  take("hands", options.hand_ratio);
  take("exposure", options.exposure_ratio);
  take("psf", options.psf_sigma_px);
  take("noise", options.noise_grey);
  std::int64_t seed = static_cast<std::int64_t>(options.seed);
  take("seed", seed);
  if (seed < 0) {
    throw UsageError("--seed must not be negative");
  }
  options.seed = static_cast<std::uint64_t>(seed);
  take("threads", options.num_threads);
  if (values.count("tilt") > 0) {
    options.tilt_deg = values["tilt"].as<double>();
  }
  if (values.count("resolution") > 0) {
    setResolution(values["resolution"].as<std::string>(), options);
  }
  check(options);
  return options;
}

std::string simulateHelp() { return kHelp; }

}  // namespace tartan_calib::apps
