#include "common/command_line.h"

#include <iostream>
#include <string>

#include "common/program.h"

namespace tartan_calib::apps {

namespace po = boost::program_options;

po::variables_map parseCommandLine(int argc, char** argv, const po::options_description& options,
                                   const po::positional_options_description& files) {
  po::variables_map values;
  try {
    po::store(po::command_line_parser(argc, argv).options(options).positional(files).run(), values);
  } catch (const po::error& error) {
    throw UsageError(std::string(error.what()) + "; see --help");
  }
  return values;
}

std::optional<int> answerHelp(int argc, const po::variables_map& values, const char* help) {
  if (argc > 1 && values.count("help") == 0) {
    return std::nullopt;
  }
  std::cout << help;
  return argc == 1 ? kWrongUsage : kSuccess;
}

}  // namespace tartan_calib::apps
