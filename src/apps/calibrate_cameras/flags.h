#pragma once

#include <boost/program_options.hpp>
#include <string>
#include <utility>
#include <vector>

namespace tartan_calib::apps {

/// The flags of a command line with their values.
class Flags {
 public:
  explicit Flags(boost::program_options::variables_map values) : values_(std::move(values)) {}

  bool has(const std::string& name) const { return values_.count(name) > 0; }

  template <class T>
  T get(const std::string& name, T fallback = {}) const {
    return has(name) ? values_[name].as<T>() : fallback;
  }

  const boost::program_options::variables_map& values() const { return values_; }

 private:
  boost::program_options::variables_map values_;
};

/// Parses the words after the program's name as Python's argparse does for kalibr_calibrate_cameras: any order, unambiguous
/// prefixes, `--flag=value`, lists that end at the next `--`, negative numbers as values, the last one of a flag given
/// twice;
/// `_` may stand for `-`. A prefix that Kalibr's own flags make unambiguous stays so among ours.
/// Throws UsageError that names the flag.
Flags parseFlags(const std::vector<std::string>& words);

/// The words with every flag by its full name: `--topic` becomes `--topics`, `-h` `--help`. Throws UsageError where a flag
/// is unknown or ambiguous.
std::vector<std::string> withFullNames(const std::vector<std::string>& words);

/// Kalibr's flags, and those of this program alone; without the leading `--`.
std::vector<std::string> kalibrFlags();
std::vector<std::string> ownFlags();

}  // namespace tartan_calib::apps
