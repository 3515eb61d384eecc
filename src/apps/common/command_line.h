#pragma once

#include <boost/program_options.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tartan_calib::apps {

/// The values of a command line. Throws UsageError for what `options` do not describe.
boost::program_options::variables_map parseCommandLine(
    const std::vector<std::string>& words, const boost::program_options::options_description& options,
    const boost::program_options::positional_options_description& files = {});

/// Takes over a value that was given.
template <class T>
void takeValue(const boost::program_options::variables_map& values, const char* name, T& member) {
  if (values.count(name) > 0) {
    member = values[name].as<T>();
  }
}

/// Prints the help where it is asked for, by `--help` or an empty command line. The exit code where that is all; nothing
/// where the program is to run.
std::optional<int> answerHelp(const std::vector<std::string>& words, const boost::program_options::variables_map& values,
                              const char* help);

}  // namespace tartan_calib::apps
