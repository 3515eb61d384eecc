#include <ctime>
#include <iostream>
#include <string>
#include <vector>

#include "common/program.h"
#include "tartan_calib/detection/target_detector.h"
#include "tartan_calib/io/target_yaml.h"
#include "tartan_calib/median.h"
#include "tartan_calib/ros/bag_reader.h"

namespace {

using namespace tartan_calib;

constexpr const char* kHelp =
    R"(Processor time of the detector on one core, without reading and decoding.

  time_detector recording.bag target.yaml topic...

Prints the number of images, the median of the time per pixel [ns] and the sum [s].
)";

double since_s(std::clock_t start) { return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC; }

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() < 3) {
    throw apps::UsageError(std::string("recording, target or topic is missing\n") + kHelp);
  }
  const detection::TargetDetector detector(io::loadTarget(arguments[1]).target);
  std::vector<double> times_per_pixel_ns;
  double sum_s = 0.0;
  for (const auto& stream : ros::openBag(arguments[0], {arguments.begin() + 2, arguments.end()}, {})) {
    const pipeline::ImageSource source = stream.open();
    while (const auto image = source()) {
      const cv::Mat gray = image->load();
      const std::clock_t start = std::clock();
      detector.detect(gray);
      const double time_s = since_s(start);
      sum_s += time_s;
      times_per_pixel_ns.push_back(1e9 * time_s / static_cast<double>(gray.total()));
    }
  }
  if (times_per_pixel_ns.empty()) {
    throw InputError(arguments[0] + " has no images");
  }
  std::cout << "images " << times_per_pixel_ns.size() << "\nmedian " << upperMedian(times_per_pixel_ns) << " ns\nsum "
            << sum_s << " s\n";
  return apps::kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  return apps::runProgram([&] { return run({argv + 1, argv + argc}); });
}
