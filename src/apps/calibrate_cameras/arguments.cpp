#include "calibrate_cameras/arguments.h"

#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdlib>
#include <map>

#include "calibrate_cameras/rig_file.h"
#include "common/program.h"

namespace tartan_calib::apps {
namespace {

namespace po = boost::program_options;
using Words = std::vector<std::string>;

po::options_description kalibrOptions() {
  const auto text = [] { return po::value<std::string>(); };
  const auto list = [] { return po::value<Words>()->multitoken(); };
  po::options_description options;
  options.add_options()("models", list(), "")("bag", text(), "")("topics", list(), "")("target", text(), "")(
      "bag-from-to", po::value<std::vector<double>>()->multitoken(), "")("bag-freq", po::value<double>(), "")(
      "approx-sync", po::value<double>(), "")("qr-tol", po::value<double>(), "")("mi-tol", po::value<double>(), "")(
      "no-shuffle", "")("no-outliers-removal", "")("no-final-filtering", "")("min-views-outlier", po::value<int>(), "")(
      "use-blakezisserman", "")("plot-outliers", "")("verbose", "")("show-extraction", "")("plot", "")(
      "dont-show-report", "")("export-poses", "")("help", "");
  return options;
}

po::options_description ownOptions() {
  po::options_description options;
  options.add_options()("init", po::value<std::string>(), "")("fix", po::value<Words>()->multitoken()->composing(), "")(
      "estimate-board-warp", "")("linear-solver", po::value<std::string>(), "")("threads", po::value<int>(), "")(
      "export-corners", "")("corners", po::value<std::string>(), "")("no-report", "")("max-rounds", po::value<int>(), "");
  return options;
}

Words names(const po::options_description& description) {
  Words result;
  for (const auto& option : description.options()) {
    result.push_back(option->long_name());
  }
  return result;
}

std::string joined(const Words& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "--" : ", --") + word;
  }
  return text;
}

Words withPrefix(const Words& all, const std::string& prefix) {
  Words matches;
  for (const std::string& name : all) {
    if (name == prefix) {
      return {name};
    }
    if (name.compare(0, prefix.size(), prefix) == 0) {
      matches.push_back(name);
    }
  }
  return matches;
}

/// The flag that a word such as `--topic` or `--no_shuffle` means.
std::string fullName(std::string prefix) {
  std::replace(prefix.begin(), prefix.end(), '_', '-');
  const Words of_kalibr = withPrefix(kalibrFlags(), prefix);
  const Words own = withPrefix(ownFlags(), prefix);
  if (of_kalibr.size() == 1 && !(own.size() == 1 && own.front() == prefix)) {
    return of_kalibr.front();
  }
  if (own.size() == 1 && (of_kalibr.empty() || own.front() == prefix)) {
    return own.front();
  }
  if (of_kalibr.empty() && own.empty()) {
    throw UsageError("unknown flag --" + prefix + "; see --help");
  }
  Words all = of_kalibr;
  all.insert(all.end(), own.begin(), own.end());
  throw UsageError("flag --" + prefix + " is ambiguous: " + joined(all));
}

/// Every flag by its full name.
Words expanded(const Words& words) {
  Words result;
  for (const std::string& word : words) {
    if (word == "-h") {
      result.emplace_back("--help");
    } else if (word.size() > 2 && word.compare(0, 2, "--") == 0) {
      const std::size_t end = std::min(word.find('='), word.size());
      result.push_back("--" + fullName(word.substr(2, end - 2)) + word.substr(end));
    } else {
      result.push_back(word);
    }
  }
  return result;
}

/// Of a flag that is given more than once the last one counts, except for --fix, which collects.
void keepLast(std::vector<po::option>& options) {
  std::map<std::string, std::size_t> last;
  for (std::size_t i = 0; i < options.size(); ++i) {
    last[options[i].string_key] = i;
  }
  std::vector<po::option> kept;
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (options[i].string_key == "fix" || last.at(options[i].string_key) == i) {
      kept.push_back(options[i]);
    }
  }
  options = kept;
}

po::variables_map parse(const Words& words) {
  po::options_description description;
  description.add(kalibrOptions()).add(ownOptions());
  const int style = po::command_line_style::allow_long | po::command_line_style::long_allow_adjacent |
                    po::command_line_style::long_allow_next;
  po::variables_map values;
  try {
    po::parsed_options parsed = po::command_line_parser(expanded(words)).options(description).style(style).run();
    for (const po::option& option : parsed.options) {
      if (option.string_key.empty()) {
        throw UsageError("unexpected word '" + option.original_tokens.front() + "'; see --help");
      }
    }
    keepLast(parsed.options);
    po::store(parsed, values);
  } catch (const po::error& error) {
    throw UsageError(std::string(error.what()) + "; see --help");
  }
  return values;
}

/// Typed access to parsed flags.
class Values {
 public:
  explicit Values(po::variables_map values) : values_(std::move(values)) {}

  bool has(const std::string& name) const { return values_.count(name) > 0; }

  template <class T>
  T get(const std::string& name, T fallback = {}) const {
    return has(name) ? values_[name].as<T>() : fallback;
  }

 private:
  po::variables_map values_;
};

io::RecordingOptions selectionFrom(const Values& values) {
  io::RecordingOptions selection;
  if (values.has("bag-from-to")) {
    const auto window = values.get<std::vector<double>>("bag-from-to");
    if (window.size() != 2) {
      throw UsageError("--bag-from-to needs two numbers of seconds: the start and the end");
    }
    selection.window = io::TimeWindow{window[0], window[1]};
  }
  if (values.has("bag-freq")) {
    selection.max_rate_hz = values.get<double>("bag-freq");
  }
  return selection;
}

calibration::LinearSolver linearSolver(const std::string& name) {
  if (name == "schur") {
    return calibration::LinearSolver::kSchur;
  }
  if (name == "sparse") {
    return calibration::LinearSolver::kSparse;
  }
  if (name != "auto") {
    throw UsageError("--linear-solver is schur, sparse or auto, not '" + name + "'");
  }
  return calibration::LinearSolver::kAuto;
}

/// Index of `camN`; empty for any other word.
std::optional<int> cameraIndex(const std::string& word) {
  constexpr std::size_t kMaxDigits = 3;
  const std::string digits = word.compare(0, 3, "cam") == 0 ? word.substr(3) : "";
  const bool is_index =
      !digits.empty() && digits.size() <= kMaxDigits && digits.find_first_not_of("0123456789") == std::string::npos;
  return is_index ? std::make_optional(std::stoi(digits)) : std::nullopt;
}

void applyFix(const Words& parts, calibration::SolveOptions& solve) {
  for (const std::string& part : parts) {
    if (part == "intrinsics") {
      solve.fix_intrinsics = true;
    } else if (part == "extrinsics") {
      solve.fix_extrinsics = true;
    } else if (const std::optional<int> index = cameraIndex(part)) {
      solve.fixed_cameras.push_back(*index);
    } else {
      throw UsageError("--fix takes intrinsics, extrinsics or a camera such as cam1, not '" + part + "'");
    }
  }
}

pipeline::CalibrateOptions calibrateFrom(const Values& values) {
  constexpr double kNsPerSecond = 1e9;
  constexpr double kMaxSync_s = 1e6;
  pipeline::CalibrateOptions options;
  options.models = values.get<Words>("models");
  const double sync_s = values.get("approx-sync", static_cast<double>(options.approx_sync_ns) / kNsPerSecond);
  if (!(sync_s >= 0.0 && sync_s <= kMaxSync_s)) {
    throw UsageError("--approx-sync must be a number of seconds, not negative");
  }
  options.approx_sync_ns = std::llround(sync_s * kNsPerSecond);
  options.num_threads = values.get("threads", options.num_threads);
  if (options.num_threads < 0) {
    throw UsageError("--threads must not be negative; 0 uses all cores");
  }
  calibration::SolveOptions& solve = options.solve;
  solve.remove_outliers = !values.has("no-outliers-removal");
  solve.final_filtering = !values.has("no-final-filtering");
  solve.use_blake_zisserman = values.has("use-blakezisserman");
  solve.estimate_board_warp = values.has("estimate-board-warp");
  solve.min_views_outlier = values.get("min-views-outlier", solve.min_views_outlier);
  if (solve.min_views_outlier < 1) {
    throw UsageError("--min-views-outlier must be a positive integer");
  }
  options.max_rounds = values.get("max-rounds", options.max_rounds);
  if (options.max_rounds < 0) {
    throw UsageError("--max-rounds must not be negative; 0 leaves the rounds out");
  }
  solve.linear_solver = linearSolver(values.get<std::string>("linear-solver", "auto"));
  applyFix(values.get<Words>("fix"), solve);
  return options;
}

void checkComplete(const Arguments& arguments, const Values& values) {
  const bool has_corners = !arguments.corners_file.empty();
  const bool has_init = !arguments.init_file.empty();
  const auto require = [](bool is_there, const std::string& what) {
    if (!is_there) {
      throw UsageError(what + "; see --help");
    }
  };
  require(!arguments.target_file.empty(), "--target is missing: the YAML file of the board");
  require(!arguments.recording.empty() || has_corners, "--bag is missing: a ROS bag or a folder with images");
  require(!arguments.topics.empty() || has_corners || has_init, "--topics is missing: the image topics in the bag");
  require(!arguments.calibrate.models.empty() || has_init, "--models is missing: one camera model per topic");
  require(!values.has("fix") || has_init, "--fix needs --init, the calibration to keep parts of");
  const std::size_t num_models = arguments.calibrate.models.size();
  const std::size_t num_topics = arguments.topics.size();
  require(num_models == num_topics || num_models == 0 || num_topics == 0,
          "exactly one camera model per topic is needed: --models has " + std::to_string(num_models) + ", --topics has " +
              std::to_string(num_topics));
}

}  // namespace

std::vector<std::string> kalibrFlags() { return names(kalibrOptions()); }

std::vector<std::string> ownFlags() { return names(ownOptions()); }

Arguments parseArguments(const std::vector<std::string>& words) {
  const Values values(parse(withRigFile(words)));
  Arguments arguments;
  arguments.help = values.has("help");
  if (arguments.help) {
    return arguments;
  }
  arguments.verbose = values.has("verbose");
  arguments.recording = values.get<std::string>("bag");
  arguments.corners_file = values.get<std::string>("corners");
  arguments.topics = values.get<Words>("topics");
  arguments.target_file = values.get<std::string>("target");
  arguments.init_file = values.get<std::string>("init");
  arguments.selection = selectionFrom(values);
  arguments.calibrate = calibrateFrom(values);
  arguments.export_poses = values.has("export-poses");
  arguments.export_corners = values.has("export-corners");
  checkComplete(arguments, values);
  return arguments;
}

std::optional<double> focalHint(const char* value) {
  constexpr double kMinFocal_px = 10.0;
  constexpr double kMaxFocal_px = 1e6;
  if (value == nullptr) {
    return std::nullopt;
  }
  char* end = nullptr;
  const double focal_px = std::strtod(value, &end);
  const bool is_number = end != value && *end == '\0';
  return is_number && focal_px > kMinFocal_px && focal_px < kMaxFocal_px ? std::make_optional(focal_px) : std::nullopt;
}

}  // namespace tartan_calib::apps
