#include "calibrate_cameras/flags.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "common/program.h"
#include "tartan_calib/text.h"

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
  const auto columns = [] { return po::value<std::vector<double>>()->multitoken()->composing(); };
  po::options_description options;
  auto add = options.add_options();
  add("rig", po::value<std::string>(), "");
  add("init", po::value<std::string>(), "");
  add("fix", po::value<Words>()->multitoken()->composing(), "");
  add("estimate-board-warp", "");
  add("estimate-pupil-shift", "");
  add("linear-solver", po::value<std::string>(), "");
  add("threads", po::value<int>(), "");
  add("export-corners", "");
  add("corners", po::value<std::string>(), "");
  add("no-report", "");
  add("max-rounds", po::value<int>(), "");
  add("min-tags", po::value<int>(), "");
  add("min-border-distance", po::value<double>(), "");
  add("corner-filter", po::value<std::string>(), "");
  add("correction-threshold", po::value<double>(), "");
  add("projections", po::value<Words>()->multitoken()->composing(), "");
  add("fovs", columns(), "");
  add("poses", columns(), "");
  add("resolutions", columns(), "");
  add("refinement", po::value<std::string>(), "");
  add("symmetry-window", po::value<double>(), "");
  add("window-scale", po::value<double>(), "");
  add("min-resize-window-size", po::value<int>(), "");
  add("max-resize-window-size", po::value<int>(), "");
  return options;
}

Words names(const po::options_description& description) {
  Words result;
  for (const auto& option : description.options()) {
    result.push_back(option->long_name());
  }
  return result;
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
    throw UsageError("unrecognised option '--" + prefix + "'; see --help");
  }
  Words all = of_kalibr;
  all.insert(all.end(), own.begin(), own.end());
  throw UsageError("flag --" + prefix + " is ambiguous: --" + joined(all, ", --"));
}

/// A list takes at least one word, even where that is the next flag.
void checkValues(const po::option& option) {
  for (const std::string& value : option.value) {
    if (value.compare(0, 2, "--") == 0) {
      throw UsageError("a value is missing between --" + option.string_key + " and " + value + "; see --help");
    }
  }
}

/// Of a flag that is given more than once the last one counts, except for those that collect.
void keepLast(std::vector<po::option>& options) {
  const std::set<std::string> collecting = {"fix", "projections", "fovs", "poses", "resolutions"};
  std::map<std::string, std::size_t> last;
  for (std::size_t i = 0; i < options.size(); ++i) {
    last[options[i].string_key] = i;
  }
  std::vector<po::option> kept;
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (collecting.count(options[i].string_key) > 0 || last.at(options[i].string_key) == i) {
      kept.push_back(options[i]);
    }
  }
  options = kept;
}

/// The two rows of a table; where one holds more values than the other, they would be taken for those of other columns.
void checkRows(const std::string& flag, const std::vector<po::option>& options) {
  std::vector<std::size_t> lengths;
  Words texts;
  for (const po::option& option : options) {
    if (option.string_key == flag) {
      lengths.push_back(option.value.size());
      texts.push_back(std::to_string(option.value.size()));
    }
  }
  const bool are_two = lengths.size() == 2 && lengths.front() == lengths.back();
  if (lengths.size() > 1 && !are_two) {
    throw UsageError("--" + flag + " takes two rows with one value for each of the --projections; its rows have " +
                     joined(texts) + " values");
  }
}

}  // namespace

std::vector<std::string> kalibrFlags() { return names(kalibrOptions()); }

std::vector<std::string> ownFlags() { return names(ownOptions()); }

Words withFullNames(const Words& words) {
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

Flags parseFlags(const std::vector<std::string>& words) {
  po::options_description description;
  description.add(kalibrOptions()).add(ownOptions());
  const int style = po::command_line_style::allow_long | po::command_line_style::long_allow_adjacent |
                    po::command_line_style::long_allow_next;
  po::variables_map values;
  try {
    po::parsed_options parsed = po::command_line_parser(withFullNames(words)).options(description).style(style).run();
    for (const po::option& option : parsed.options) {
      if (option.string_key.empty()) {
        throw UsageError("unexpected word '" + option.original_tokens.front() + "'; see --help");
      }
      checkValues(option);
    }
    for (const char* flag : {"fovs", "poses", "resolutions"}) {
      checkRows(flag, parsed.options);
    }
    keepLast(parsed.options);
    po::store(parsed, values);
  } catch (const po::error& error) {
    throw UsageError(std::string(error.what()) + "; see --help");
  }
  return Flags(std::move(values));
}

}  // namespace tartan_calib::apps
