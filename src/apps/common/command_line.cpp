#include "common/command_line.h"

#include <iostream>
#include <string>

#include "common/program.h"

namespace tartan_calib::apps {

namespace po = boost::program_options;

po::variables_map parseCommandLine(const std::vector<std::string>& words, const po::options_description& options,
                                   const po::positional_options_description& files) {
  po::variables_map values;
  try {
    po::store(po::command_line_parser(words).options(options).positional(files).run(), values);
  } catch (const po::error& error) {
    throw UsageError(std::string(error.what()) + "; see --help");
  }
  return values;
}

std::optional<int> answerHelp(const std::vector<std::string>& words, const po::variables_map& values, const char* help) {
  if (!words.empty() && values.count("help") == 0) {
    return std::nullopt;
  }
  std::cout << help;
  return words.empty() ? kWrongUsage : kSuccess;
}

}  // namespace tartan_calib::apps
