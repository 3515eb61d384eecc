#include "tartan_calibrate/tartan_flags.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "calibrate_cameras/flags.h"
#include "calibrate_cameras/rig_file.h"
#include "common/program.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

using Words = std::vector<std::string>;

struct TartanFlag;

/// A flag of TartanCalib in a command line.
struct Given {
  const TartanFlag* flag = nullptr;
  std::string word;  ///< as it was written
  Words values;
};

/// What becomes of one flag of TartanCalib by itself.
using Apply = std::function<void(const Given& given, TartanCommand& command)>;

struct TartanFlag {
  std::string name;
  std::size_t max_values;
  Apply apply;
};

constexpr std::size_t kAnyNumber = 1000;
constexpr const char* kThreshold = "correction-threshold";
constexpr const char* kMinWindow = "min-resize-window-size";
constexpr const char* kMaxWindow = "max-resize-window-size";

bool contains(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

double number(const Given& given) {
  const std::string value = given.values.empty() ? "" : given.values.front();
  char* end = nullptr;
  const double result = std::strtod(value.c_str(), &end);
  if (value.empty() || *end != '\0' || !std::isfinite(result)) {
    throw UsageError(given.word + " needs a number" + (value.empty() ? "" : ", not '" + value + "'"));
  }
  return result;
}

void wholePixels(const Given& given) {
  if (std::floor(number(given)) != number(given)) {
    throw UsageError(given.word + " needs whole pixels, not '" + given.values.front() + "'");
  }
}

std::string text(const Given& given) {
  if (given.values.empty()) {
    throw UsageError(given.word + " needs a value; see --help");
  }
  return given.values.front();
}

/// Of a flag that takes a number, none, or (kText) anything.
enum class Value { kNone, kNumber, kText };

TartanFlag withoutEffect(const char* flag, Value value, const std::string& reason) {
  const auto apply = [value, reason](const Given& given, TartanCommand& command) {
    if (value == Value::kNumber) {
      number(given);
    }
    command.notes.push_back(given.word + " has no effect: " + reason);
  };
  return {flag, value == Value::kNone ? 0U : 1U, apply};
}

void applyProjections(const Given& given, TartanCommand& command) {
  const Words values = given.values.empty() ? Words{"none"} : given.values;
  command.words.emplace_back("--projections");
  command.words.insert(command.words.end(), values.begin(), values.end());
}

void applyDebugModes(const Given& given, TartanCommand& command) {
  constexpr std::array kModes = {"pointcloudprojection", "pinholeprojection",     "originalprojection",
                                 "targetpointcloud",     "individualprojections", "reprojectionpoints"};
  for (const std::string& mode : given.values) {
    if (mode == "none") {
      continue;
    }
    if (std::find(kModes.begin(), kModes.end(), mode) == kModes.end()) {
      throw UsageError(given.word + " takes " + joined(Words(kModes.begin(), kModes.end()), " ") + " and none, not '" +
                       mode + "'");
    }
    command.debug_modes.push_back(mode);
  }
}

/// Every flag that TartanCalib has and calibrate_cameras has not, not with this meaning, or without effect.
const std::vector<TartanFlag>& tartanFlags() {
  const auto check_number = [](const Given& given, TartanCommand& /*command*/) { number(given); };
  const auto check_pixels = [](const Given& given, TartanCommand& /*command*/) { wholePixels(given); };
  const std::string every_view = "every view takes part, weighted by the uncertainty of its corners";
  const std::string one_batch = "every view is used, and all are solved in one batch";
  const std::string no_windows = "no windows are opened; the report has the plots";
  static const std::vector<TartanFlag> flags = {
      {"projections", kAnyNumber, applyProjections},
      {"debug-modes", kAnyNumber, applyDebugModes},
      {"save-dir", 1, [](const Given& given, TartanCommand& command) { command.save_dir = text(given); }},
      {"log-dest", 1, [](const Given& given, TartanCommand& command) { command.log_dest = text(given); }},
      {"debug-image-dir", 1, [](const Given& given, TartanCommand& command) { command.debug_image_dir = text(given); }},
      withoutEffect("min-init-corners-autocomplete", Value::kNumber,
                    "images with few corners or none are gone through as well"),
      withoutEffect("min-tag-size-autocomplete", Value::kNumber,
                    "corners are looked for where the nearest other one is at least 4 px away"),
      {kThreshold, 1, check_number},
      {kMinWindow, 1, check_pixels},
      {kMaxWindow, 1, check_pixels},
      {"symmetry-refinement", 0,
       [](const Given& /*given*/, TartanCommand& command) {
         command.words.insert(command.words.end(), {"--refinement", "symmetry"});
       }},
      withoutEffect("refine-magnitude-reject", Value::kNumber,
                    "refinement ends 1.5 px from its start, and corners must agree with their neighbours"),
      withoutEffect("symmetry-edge-threshold", Value::kNumber,
                    "corners are refined up to where their window leaves the image"),
      withoutEffect("export-dataset-dir", Value::kText,
                    "its format is read by TartanCalib's own libvis only; --export-corners writes the corners"),
      withoutEffect("outputMatlab", Value::kNone, "no files of MATLAB's are written; --export-corners writes the corners"),
      withoutEffect("polar-setting", Value::kNumber, every_view),
      withoutEffect("polar-cutoff", Value::kNumber, every_view),
      withoutEffect("force-all", Value::kNone, every_view),
      withoutEffect("qr-tol", Value::kNumber, one_batch),
      withoutEffect("mi-tol", Value::kNumber, one_batch),
      withoutEffect("no-shuffle", Value::kNone,
                    "all views are solved in one batch, in which their order makes no difference"),
      withoutEffect("plot", Value::kNone, no_windows),
      withoutEffect("plot-outliers", Value::kNone, no_windows),
      withoutEffect("show-extraction", Value::kNone, no_windows),
  };
  return flags;
}

/// Words after position `at` that belong to the flag there.
Words valuesAfter(const Words& words, std::size_t at, std::size_t max_values) {
  Words values;
  for (std::size_t i = at + 1; i < words.size() && values.size() < max_values; ++i) {
    if (words[i].compare(0, 2, "--") == 0) {
      break;
    }
    values.push_back(words[i]);
  }
  return values;
}

bool beginsWith(const std::string& word, const std::string& start) { return word.compare(0, start.size(), start) == 0; }

/// The flag of TartanCalib that a word such as `--save_d` means; null where it is, or may be, one of calibrate_cameras.
const TartanFlag* findFlag(const std::string& word) {
  if (word.size() < 3 || !beginsWith(word, "--")) {
    return nullptr;
  }
  std::string name = word.substr(2, word.find('=') - 2);
  std::replace(name.begin(), name.end(), '_', '-');
  const TartanFlag* found = nullptr;
  for (const TartanFlag& flag : tartanFlags()) {
    if (name == flag.name) {
      return &flag;
    }
    if (beginsWith(flag.name, name)) {
      if (found != nullptr) {
        throw UsageError("flag " + word + " is ambiguous: --" + found->name + ", --" + flag.name);
      }
      found = &flag;
    }
  }
  const Words others = kalibrFlags();
  const bool is_other = std::any_of(others.begin(), others.end(), [&](const auto& other) {
    return beginsWith(other, name) && (found == nullptr || other != found->name);
  });
  return is_other ? nullptr : found;
}

/// TartanCalib's default, where flags of views are given without projections: they have no effect on it.
void chooseProjections(const Flags& flags, TartanCommand& command) {
  if (!flags.has("projections") && (flags.has("fovs") || flags.has("poses") || flags.has("resolutions"))) {
    command.words.insert(command.words.end(), {"--projections", "cornerpredictor"});
  }
}

/// TartanCalib looks for corners at their predictions only where it is told to.
void chooseRounds(const Flags& flags, TartanCommand& command) {
  const auto projections = flags.get<Words>("projections");
  if (projections.empty() || contains(projections, "cornerpredictor") || flags.has("max-rounds") || flags.has("corners")) {
    return;
  }
  command.words.insert(command.words.end(), {"--max-rounds", "0"});
  const bool has_views =
      std::any_of(projections.begin(), projections.end(), [](const auto& each) { return each != "none"; });
  command.notes.push_back("--projections " + joined(projections, " ") + ": corners are not looked for at their predictions" +
                          (has_views ? "; add cornerpredictor for both" : ""));
}

/// Limits of adaptive windows ask for these; where symmetry was asked for as well, they mean nothing.
void chooseRefinement(const Flags& flags, const std::vector<Given>& all, TartanCommand& command) {
  const auto refinement = flags.get<std::string>("refinement");
  bool is_limited = false;
  for (const Given& given : all) {
    if (given.flag->name != kMinWindow && given.flag->name != kMaxWindow) {
      continue;
    }
    if (refinement == "symmetry") {
      command.notes.push_back(given.word + " has no effect: symmetry is judged in a window on the board");
      continue;
    }
    is_limited = true;
    const std::string size_px = std::to_string(std::lround(number(given)));
    command.words.insert(command.words.end(), {"--" + given.flag->name, size_px});
  }
  if (is_limited && refinement.empty()) {
    command.words.insert(command.words.end(), {"--refinement", "adaptive"});
    command.notes.emplace_back(
        "limits of windows choose adaptive refinement; without them corners are refined by symmetry, which is more "
        "accurate");
  }
}

/// A threshold asks for the filter by quadrilaterals. TartanCalib compares it with squared distances.
void chooseFilter(const Flags& flags, const std::vector<Given>& all, TartanCommand& command) {
  const auto given = std::find_if(all.rbegin(), all.rend(), [](const Given& each) { return each.flag->name == kThreshold; });
  if (given == all.rend()) {
    return;
  }
  const double threshold_px2 = number(*given);
  if (threshold_px2 <= 0.0) {
    throw UsageError(given->word + " must be above 0: TartanCalib compares it with squared pixels");
  }
  if (flags.get<std::string>("corner-filter") == "image") {
    command.notes.push_back(given->word + " has no effect: --corner-filter image looks for no quadrilaterals");
    return;
  }
  const std::string threshold_px = std::to_string(std::sqrt(threshold_px2));
  command.words.insert(command.words.end(), {"--corner-filter", "quads", "--correction-threshold", threshold_px});
  command.notes.push_back(given->word + " filters corners by quadrilaterals within " + threshold_px +
                          " px; without it they are tested in the image, which finds more");
}

/// Pictures of images need images.
void chooseModes(const Flags& flags, TartanCommand& command) {
  if (!flags.has("corners")) {
    return;
  }
  Words& modes = command.debug_modes;
  const auto unused = std::stable_partition(modes.begin(), modes.end(), [](const std::string& mode) {
    return mode == "reprojectionpoints" || mode == "targetpointcloud" || mode == "pointcloudprojection";
  });
  if (unused != modes.end()) {
    command.notes.push_back("--debug-modes " + joined(Words(unused, modes.end()), " ") +
                            " has no effect: --corners brings no images");
    modes.erase(unused, modes.end());
  }
}

/// What TartanCalib's flags mean beside the others, in whatever order and spelling they are.
void decide(const std::vector<Given>& all, TartanCommand& command) {
  const Flags flags = parseFlags(command.words);
  command.help = flags.has("help");
  chooseProjections(flags, command);
  chooseRounds(flags, command);
  chooseRefinement(flags, all, command);
  chooseFilter(flags, all, command);
  chooseModes(flags, command);
  if (contains(flags.get<Words>("projections"), "pinhole") && !flags.has("poses")) {
    command.notes.emplace_back(
        "without --poses the view of --projections pinhole looks along the camera's -y axis, as in TartanCalib; ahead is "
        "--poses 0 --poses 0");
  }
}

}  // namespace

TartanCommand translateTartanFlags(const Words& command_line) {
  const Words words = withRigFile(command_line);
  TartanCommand command;
  std::vector<Given> all;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "-h" || words[i] == "--help") {
      command.help = true;
      return command;
    }
    const TartanFlag* flag = findFlag(words[i]);
    if (flag == nullptr) {
      command.words.push_back(words[i]);
      continue;
    }
    const std::size_t equals = words[i].find('=');
    const bool is_joined = equals != std::string::npos;
    all.push_back({flag, words[i].substr(0, equals),
                   is_joined ? Words{words[i].substr(equals + 1)} : valuesAfter(words, i, flag->max_values)});
    flag->apply(all.back(), command);
    i += is_joined ? 0 : all.back().values.size();
  }
  decide(all, command);
  return command;
}

}  // namespace tartan_calib::apps
