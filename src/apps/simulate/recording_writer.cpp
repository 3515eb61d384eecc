#include "simulate/recording_writer.h"

#include <unistd.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <system_error>

#include "tartan_calib/error.h"
#include "tartan_calib/ros/bag_writer.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

namespace fs = std::filesystem;

class BagRecording : public RecordingWriter {
 public:
  explicit BagRecording(const std::string& path) : bag_(path) {}

  void write(const simulation::RenderedFrame& frame) override {
    for (std::size_t camera = 0; camera < frame.views.size(); ++camera) {
      bag_.writeImage(imageTopic(camera), frame.stamp_ns, frame.views[camera].image);
    }
  }
  void finish() override { bag_.close(); }

 private:
  ros::BagWriter bag_;
};

/// Written under a temporary name beside the folder.
class FolderRecording : public RecordingWriter {
 public:
  explicit FolderRecording(const std::string& folder)
      : folder_(fs::absolute(folder).lexically_normal()), temporary_(folder_) {
    if (!folder_.has_filename()) {  // "folder/"
      folder_ = folder_.parent_path();
    }
    temporary_ = folder_.string() + ".partial-" + std::to_string(::getpid());
    if (fs::exists(folder_)) {
      throw InputError(folder + " exists already; remove it or choose another --output-dir");
    }
    makeFolder(temporary_);
  }

  ~FolderRecording() override {
    std::error_code ignored;
    fs::remove_all(temporary_, ignored);
  }

  void write(const simulation::RenderedFrame& frame) override {
    for (std::size_t camera = 0; camera < frame.views.size(); ++camera) {
      const fs::path camera_folder = temporary_ / cameraName(camera);
      makeFolder(camera_folder);
      const fs::path file = camera_folder / (std::to_string(frame.stamp_ns) + ".png");
      if (!cv::imwrite(file.string(), frame.views[camera].image)) {
        throw InputError("cannot write " + file.string() + "; is the disk full?");
      }
    }
  }

  void finish() override {
    std::error_code error;
    fs::rename(temporary_, folder_, error);
    if (error) {
      throw InputError("cannot write the folder " + folder_.string() + ": " + error.message());
    }
  }

 private:
  static void makeFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
      throw InputError("cannot make the folder " + folder.string() + ": " + error.message());
    }
  }

  fs::path folder_;
  fs::path temporary_;
};

}  // namespace

std::string imageTopic(std::size_t camera_index) { return "/cam" + std::to_string(camera_index) + "/image_raw"; }

std::unique_ptr<RecordingWriter> makeBagWriter(const std::string& bag_path) {
  return std::make_unique<BagRecording>(bag_path);
}

std::unique_ptr<RecordingWriter> makeFolderWriter(const std::string& folder) {
  return std::make_unique<FolderRecording>(folder);
}

}  // namespace tartan_calib::apps
