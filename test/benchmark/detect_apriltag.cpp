#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <ctime>
#include <iostream>
#include <map>
#include <memory>

#include "common/program.h"
#include "tartan_calib/io/corners_csv.h"
#include "tartan_calib/io/image_folder.h"
#include "tartan_calib/io/target_yaml.h"
#include "tartan_calib/ros/bag_reader.h"

namespace {

namespace po = boost::program_options;
using namespace tartan_calib;

constexpr const char* kHelp =
    R"(What libapriltag's own detector finds of an AprilGrid, as a corner file; scripts/benchmark compares with it.

  detect_apriltag recording.bag target.yaml corners.csv

  --topic T         (/cam0/image_raw)
  --border-cells N  width of the tags' black border for which the detector is set up: 1, its own, or 2 (1)
  --decimate D      its quad_decimate (2)

Prints the processor time that detection took on its one thread: median of a frame [ms] and sum [s].
)";

struct Arguments {
  std::string bag;
  std::string topic;
  std::string target_file;
  std::string output;
  int border_cells = 1;
  float decimate = 2.0F;
};

/// Nothing where help is asked for.
std::optional<Arguments> parse(int argc, char** argv) {
  Arguments arguments;
  po::options_description options;
  auto add = options.add_options();
  add("help,h", "");
  add("bag", po::value(&arguments.bag)->required());
  add("topic", po::value(&arguments.topic)->default_value("/cam0/image_raw"));
  add("target", po::value(&arguments.target_file)->required());
  add("output", po::value(&arguments.output)->required());
  add("border-cells", po::value(&arguments.border_cells));
  add("decimate", po::value(&arguments.decimate));
  try {
    po::variables_map values;
    po::positional_options_description files;
    files.add("bag", 1).add("target", 1).add("output", 1);
    po::store(po::command_line_parser(argc, argv).options(options).positional(files).run(), values);
    if (values.count("help") > 0) {
      return std::nullopt;
    }
    po::notify(values);
  } catch (const po::error& error) {
    throw apps::UsageError(std::string(error.what()) + "; see --help");
  }
  return arguments;
}

/// libapriltag's tag36h11 with a wider border: its cells are those of the original, moved inwards. The order of the bits
/// must stay libapriltag's, which turns a code by rotating its bits.
class Family {
 public:
  Family(const target::AprilGrid& grid, int border_cells) : family_(tag36h11_create(), tag36h11_destroy) {
    if (grid.family != "t36h11") {
      throw InputError("the target has tags of family " + grid.family + "; only t36h11 is supported");
    }
    const int added_cells = border_cells - 1;
    family_->width_at_border += 2 * added_cells;
    family_->total_width += 2 * added_cells;
    for (std::uint32_t bit = 0; bit < family_->nbits; ++bit) {
      family_->bit_x[bit] += static_cast<std::uint32_t>(added_cells);
      family_->bit_y[bit] += static_cast<std::uint32_t>(added_cells);
    }
  }

  apriltag_family_t* get() const { return family_.get(); }

 private:
  std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family_;
};

class Detector {
 public:
  Detector(const target::AprilGrid& grid, const Family& family, float decimate)
      : grid_(grid), detector_(apriltag_detector_create(), apriltag_detector_destroy) {
    apriltag_detector_add_family(detector_.get(), family.get());
    detector_->nthreads = 1;
    detector_->quad_decimate = decimate;
  }

  /// Corners of the board's tags; of a tag that was found more than once those with the clearest payload.
  std::vector<observation::Corner> detect(const cv::Mat& gray) {
    image_u8_t image = {gray.cols, gray.rows, static_cast<int32_t>(gray.step), gray.data};
    const std::clock_t start = std::clock();
    const std::unique_ptr<zarray_t, void (*)(zarray_t*)> tags(apriltag_detector_detect(detector_.get(), &image),
                                                              apriltag_detections_destroy);
    frame_times_s_.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    std::map<int, const apriltag_detection_t*> best;  // by index of the tag on the board
    for (int i = 0; i < zarray_size(tags.get()); ++i) {
      const apriltag_detection_t* tag = nullptr;
      zarray_get(tags.get(), i, static_cast<void*>(&tag));
      const int tag_index = tag->id - grid_.code_offset;
      if (tag_index < 0 || tag_index >= target::numTags(grid_)) {
        continue;
      }
      const apriltag_detection_t*& kept = best[tag_index];
      kept = kept == nullptr || tag->decision_margin > kept->decision_margin ? tag : kept;
    }
    return cornersOf(best);
  }

  const std::vector<double>& frameTimes_s() const { return frame_times_s_; }

 private:
  std::vector<observation::Corner> cornersOf(const std::map<int, const apriltag_detection_t*>& tags) const {
    constexpr double kCentreOfFirstPixel = 0.5;  // libapriltag's (0, 0) is the outer corner of the first pixel
    std::vector<observation::Corner> corners;
    for (const auto& [tag_index, tag] : tags) {
      const std::vector<int> ids = target::tagCornerIds(grid_, tag_index);  // from the bottom left anticlockwise, as p
      for (std::size_t k = 0; k < ids.size(); ++k) {
        observation::Corner corner;
        corner.corner_id = ids[k];
        corner.px = {tag->p[k][0] - kCentreOfFirstPixel, tag->p[k][1] - kCentreOfFirstPixel};
        corners.push_back(corner);
      }
    }
    std::sort(corners.begin(), corners.end(), [](const auto& a, const auto& b) { return a.corner_id < b.corner_id; });
    return corners;
  }

  target::AprilGrid grid_;
  std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)> detector_;
  std::vector<double> frame_times_s_;
};

void printTimes(std::vector<double> times_s) {
  double sum_s = 0.0;
  for (const double time_s : times_s) {
    sum_s += time_s;
  }
  const auto middle = times_s.begin() + static_cast<std::ptrdiff_t>(times_s.size() / 2);
  std::nth_element(times_s.begin(), middle, times_s.end());
  std::cout << "median " << 1e3 * *middle << " ms\nsum " << sum_s << " s\n";
}

int run(int argc, char** argv) {
  const std::optional<Arguments> arguments = parse(argc, argv);
  if (!arguments) {
    std::cout << kHelp;
    return apps::kSuccess;
  }
  const target::Target target = io::loadTarget(arguments->target_file).target;
  const auto* grid = std::get_if<target::AprilGrid>(&target);
  if (grid == nullptr) {
    throw InputError("target " + arguments->target_file + " is no aprilgrid");
  }
  const Family family(*grid, arguments->border_cells);
  Detector detector(*grid, family, arguments->decimate);
  const pipeline::CameraStream stream = ros::openBag(arguments->bag, {arguments->topic}, {}).front();
  pipeline::CameraCorners found;
  found.topic = stream.topic;
  const pipeline::ImageSource source = stream.open();
  while (const std::optional<pipeline::StampedImage> image = source()) {
    const cv::Mat gray = image->load();
    found.width = gray.cols;
    found.height = gray.rows;
    found.images.push_back({0, image->stamp_ns, detector.detect(gray)});
  }
  io::saveCorners(arguments->output, {found});
  printTimes(detector.frameTimes_s());
  return apps::kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  return apps::runProgram([&] { return run(argc, argv); });
}
