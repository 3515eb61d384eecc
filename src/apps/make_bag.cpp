#include <unistd.h>

#include <iostream>

#include "common/command_line.h"
#include "common/interrupt.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "make_bag/make_bag.h"

namespace {

namespace po = boost::program_options;
using namespace tartan_calib::apps;

constexpr const char* kHelp = R"(Makes a ROS bag of a folder with images, as kalibr_bagcreater does.

  rosrun tartan_calib make_bag --folder recording --output-bag recording.bag

recording/cam0/1606153907495166540.png (or jpg, bmp, pgm) becomes a mono8 image on /cam0/image_raw, stamped with its name
in nanoseconds; rows 'stamp_ns, wx, wy, wz, ax, ay, az' of recording/imu0.csv become sensor_msgs/Imu on /imu0.

  --folder F        folder with a subfolder of images per camera
  --output-bag B    bag to write; --output_bag is understood too
  -h, --help        this text
)";

po::variables_map parse(const std::vector<std::string>& words) {
  po::options_description options;
  options.add_options()("help,h", "")("folder", po::value<std::string>())("output-bag", po::value<std::string>())(
      "output_bag", po::value<std::string>());
  return parseCommandLine(words, options);
}

BagContents write(const std::string& folder, const std::string& bag_path) {
  ProgressBar bar(isatty(STDOUT_FILENO) != 0);
  const UninterruptedSection all_or_nothing;
  const auto tell = [&bar](const std::string& warning) {
    bar.clear();
    printWarning(warning);
  };
  const BagContents contents = makeBag(folder, bag_path, tell, [&bar](std::size_t done, std::size_t total) {
    bar.show(done, total);
    setItemsDone(done, total, "images");
    throwIfInterrupted();
  });
  bar.clear();
  setFinishedWork(bag_path + " is written");
  return contents;
}

int run(const std::vector<std::string>& words) {
  const po::variables_map values = parse(words);
  if (const std::optional<int> exit_code = answerHelp(words, values, kHelp)) {
    return *exit_code;
  }
  const char* bag_option = values.count("output_bag") > 0 ? "output_bag" : "output-bag";
  if (values.count("folder") == 0 || values.count(bag_option) == 0) {
    throw UsageError("--folder and --output-bag are needed; see --help");
  }
  const auto bag = values[bag_option].as<std::string>();
  installInterruptHandler();
  const BagContents contents = write(values["folder"].as<std::string>(), bag);
  std::cout << "Wrote " << contents.num_images << " images and " << contents.num_imu_samples << " IMU samples to " << bag
            << '\n';
  return kSuccess;
}

}  // namespace

int main(int argc, char** argv) { return runProgram(argc, argv, run); }
