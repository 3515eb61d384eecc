#include "tartan_calibrate/tartan_flags.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "calibrate_cameras/flags.h"
#include "common/program.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

using Words = std::vector<std::string>;

/// What becomes of one flag of TartanCalib.
using Apply = std::function<void(const Words& values, TartanCommand& command)>;

struct TartanFlag {
  const char* name;
  std::size_t max_values;
  Apply apply;
};

constexpr std::size_t kAnyNumber = 1000;

bool contains(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

double number(const std::string& flag, const Words& values) {
  char* end = nullptr;
  const double value = values.empty() ? 0.0 : std::strtod(values.front().c_str(), &end);
  if (values.empty() || end == values.front().c_str() || *end != '\0' || !std::isfinite(value)) {
    throw UsageError("--" + flag + " needs a number" + (values.empty() ? "" : ", not '" + values.front() + "'"));
  }
  return value;
}

std::string text(const std::string& flag, const Words& values) {
  if (values.empty()) {
    throw UsageError("--" + flag + " needs a value; see --help");
  }
  return values.front();
}

/// Of a flag that takes a number, none, or (kText) anything.
enum class Value { kNone, kNumber, kText };

TartanFlag withoutEffect(const char* flag, Value value, const std::string& reason) {
  const auto apply = [flag, value, reason](const Words& values, TartanCommand& command) {
    if (value == Value::kNumber) {
      number(flag, values);
    }
    command.notes.push_back("--" + std::string(flag) + " has no effect: " + reason);
  };
  return {flag, value == Value::kNone ? 0U : 1U, apply};
}

/// TartanCalib compares it with squared distances.
void applyCorrectionThreshold(const Words& values, TartanCommand& command) {
  const double threshold_px2 = number("correction-threshold", values);
  if (threshold_px2 <= 0.0) {
    throw UsageError("--correction-threshold must be above 0: TartanCalib compares it with squared pixels");
  }
  const std::string threshold_px = std::to_string(std::sqrt(threshold_px2));
  command.words.insert(command.words.end(), {"--corner-filter", "quads", "--correction-threshold", threshold_px});
  command.notes.push_back("--correction-threshold filters corners by quadrilaterals within " + threshold_px +
                          " px; without it they are tested in the image, which finds more");
}

void applyProjections(const Words& values, TartanCommand& command) {
  command.words.emplace_back("--projections");
  command.words.insert(command.words.end(), values.begin(), values.end());
  if (!values.empty() && !contains(values, "cornerpredictor")) {
    command.words.insert(command.words.begin(), {"--max-rounds", "0"});  // a later --max-rounds takes its place
    command.notes.push_back("--projections " + joined(values, " ") +
                            ": corners are not looked for at their predictions; add cornerpredictor for both");
  }
}

void applyDebugModes(const Words& values, TartanCommand& command) {
  constexpr std::array kModes = {"pointcloudprojection", "pinholeprojection",     "originalprojection",
                                 "targetpointcloud",     "individualprojections", "reprojectionpoints"};
  for (const std::string& mode : values) {
    if (mode == "none") {
      continue;
    }
    if (std::find(kModes.begin(), kModes.end(), mode) == kModes.end()) {
      throw UsageError("--debug-modes takes " + joined(Words(kModes.begin(), kModes.end()), " ") + " and none, not '" +
                       mode + "'");
    }
    command.debug_modes.push_back(mode);
  }
}

/// A limit of the adaptive windows, in whole pixels.
TartanFlag resizedWindow(const char* flag) {
  const auto apply = [flag](const Words& values, TartanCommand& command) {
    const long size_px = std::lround(number(flag, values));
    command.words.insert(command.words.end(), {"--" + std::string(flag), std::to_string(size_px)});
  };
  return {flag, 1, apply};
}

/// Limits of adaptive windows ask for these; where symmetry was asked for as well, they mean nothing.
void chooseRefinement(TartanCommand& command) {
  Words& words = command.words;
  const auto is_limit = [](const std::string& word) {
    return word == "--min-resize-window-size" || word == "--max-resize-window-size";
  };
  if (std::none_of(words.begin(), words.end(), is_limit)) {
    return;
  }
  if (!contains(words, "--refinement")) {
    words.insert(words.end(), {"--refinement", "adaptive"});
    command.notes.emplace_back(
        "limits of windows choose adaptive refinement; without them corners are refined by symmetry, which is more "
        "accurate");
  } else if (contains(words, "symmetry")) {
    for (auto limit = std::find_if(words.begin(), words.end(), is_limit); limit != words.end();
         limit = std::find_if(words.begin(), words.end(), is_limit)) {
      command.notes.push_back(*limit + " has no effect: symmetry is judged in a window on the board");
      words.erase(limit, limit + 2);
    }
  }
}

/// Every flag that TartanCalib has and calibrate_cameras has not, or not with this meaning.
const std::vector<TartanFlag>& tartanFlags() {
  const std::string every_view = "every view takes part, weighted by the uncertainty of its corners";
  static const std::vector<TartanFlag> flags = {
      {"projections", kAnyNumber, applyProjections},
      {"debug-modes", kAnyNumber, applyDebugModes},
      {"save-dir", 1, [](const Words& v, TartanCommand& command) { command.save_dir = text("save_dir", v); }},
      {"log-dest", 1, [](const Words& v, TartanCommand& command) { command.log_dest = text("log_dest", v); }},
      {"debug-image-dir", 1,
       [](const Words& v, TartanCommand& command) { command.debug_image_dir = text("debug_image_dir", v); }},
      withoutEffect("min-init-corners-autocomplete", Value::kNumber,
                    "images with few corners or none are gone through as well"),
      withoutEffect("min-tag-size-autocomplete", Value::kNumber,
                    "corners are looked for where the nearest other one is at least 4 px away"),
      {"correction-threshold", 1, applyCorrectionThreshold},
      resizedWindow("min-resize-window-size"),
      resizedWindow("max-resize-window-size"),
      {"symmetry-refinement", 0,
       [](const Words& /*none*/, TartanCommand& command) {
         command.words.insert(command.words.end(), {"--refinement", "symmetry"});
       }},
      withoutEffect("refine-magnitude-reject", Value::kNumber,
                    "refinement ends 1.5 px from its start, and corners must agree with their neighbours"),
      withoutEffect("symmetry-edge-threshold", Value::kNumber,
                    "corners are refined up to where their window leaves the image"),
      withoutEffect("export-dataset-dir", Value::kText,
                    "its format is read by TartanCalib's own libvis only; --export-corners writes the corners"),
      withoutEffect("outputMatlab", Value::kNone, "--export-corners writes the corners"),
      withoutEffect("polar-setting", Value::kNumber, every_view),
      withoutEffect("polar-cutoff", Value::kNumber, every_view),
      withoutEffect("force-all", Value::kNone, every_view),
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
  const bool is_other =
      std::any_of(others.begin(), others.end(), [&](const auto& other) { return beginsWith(other, name); });
  return is_other ? nullptr : found;
}

}  // namespace

TartanCommand translateTartanFlags(const Words& words) {
  TartanCommand command;
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
    if (equals != std::string::npos) {
      flag->apply({words[i].substr(equals + 1)}, command);
      continue;
    }
    const Words values = valuesAfter(words, i, flag->max_values);
    flag->apply(values, command);
    i += values.size();
  }
  chooseRefinement(command);
  if (contains(command.words, "pinhole") && !contains(command.words, "--poses")) {
    command.notes.emplace_back(
        "without --poses the view of --projections pinhole looks along the camera's -y axis, as in TartanCalib; ahead is "
        "--poses 0 --poses 0");
  }
  return command;
}

std::string tartanHelpText() {
  return R"(Calibrates cameras as calibrate_cameras does, with the flags and file names of TartanCalib's tartan_calibrate.

  rosrun tartan_calib tartan_calibrate --bag rig.bag --target april_6x6.yaml --topics /cam0/image_raw --models ds-none \
      --save_dir results/ --log_dest rig

writes results/rig0-camchain.yaml and rig0-results-cam.txt (detection alone), and the final rig1-camchain.yaml,
rig1-results-cam.txt, rig1-calibration.yaml and report.

Files
  --save_dir DIR            folder of the results, made where it is missing (/data/)
  --log_dest NAME           what their names begin with (log)
  --debug_image_dir DIR     folder of the pictures of --debug-modes (the one of --save_dir)

Where corners are looked for
  --projections P [P ...]   cornerpredictor: at their predictions, in rounds, with calibrate_cameras' tests (default)
                            pinhole, homography, cube: in virtual views remapped with the model; none: only without a model
  --correction-threshold V  filter corners by quadrilaterals, as the paper does, within sqrt(V) px (calibrate_cameras takes px)
  --fovs, --poses, --resolutions
                            of the virtual views, two rows with one value per projection: see calibrate_cameras --help

Pictures, as PNG files
  --debug-modes M [M ...]   originalprojection: images with corners, red those of detection, green those found later
                            pinholeprojection: a cube's faces in a cross; individualprojections: every virtual view
                            reprojectionpoints: all corners; targetpointcloud: the board's places before the camera
                            pointcloudprojection: where the virtual views look

All flags of calibrate_cameras work too; see calibrate_cameras --help. Flags of TartanCalib that mean nothing to this solver are
accepted, and the terminal says why they have no effect.
)";
}

}  // namespace tartan_calib::apps
