#include "inspect_bag/inspection.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "common/recording.h"
#include "tartan_calib/detection/target_detector.h"
#include "tartan_calib/error.h"
#include "tartan_calib/io/image_folder.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

/// Topics of a folder of images, told as those of a bag. File names are the only stamps.
ros::BagContents listFolder(const std::string& folder) {
  ros::BagContents contents;
  for (const pipeline::CameraStream& stream : io::openImageFolder(folder, io::imageFolderTopics(folder), {})) {
    const auto images = std::make_shared<std::vector<pipeline::StampedImage>>();
    ros::ImageTopic topic;
    topic.topic = stream.topic;
    topic.type = "image files";
    const pipeline::ImageSource source = stream.open();
    while (const std::optional<pipeline::StampedImage> image = source()) {
      images->push_back(*image);
      topic.images.push_back({image->stamp_ns, image->stamp_ns, 0, 0, ""});
    }
    topic.load = [images](std::size_t index) { return images->at(index).load(); };
    contents.image_topics.push_back(topic);
  }
  return contents;
}

/// Looks at one sampled image.
void addSample(const cv::Mat& gray, std::int64_t stamp_ns, const detection::TargetDetector* detector,
               CameraInspection& camera) {
  camera.samples.push_back(qualityOf(gray));
  camera.corners.width = gray.cols;
  camera.corners.height = gray.rows;
  ++camera.corners.num_images;
  if (detector == nullptr) {
    return;
  }
  const detection::Detection detection = detector->detect(gray);
  camera.corners.counts += detection.counts;
  if (!detection.corners.empty()) {
    camera.corners.images.push_back({0, stamp_ns, detection.corners});
  }
}

/// Indices of the images that are decoded.
std::vector<std::size_t> samplesOf(const ros::ImageTopic& topic) {
  std::vector<std::int64_t> received_ns;
  for (const ros::ImageRecord& image : topic.images) {
    received_ns.push_back(image.received_ns);
  }
  return topic.is_supported ? evenlyInTime(received_ns, kMaxSamples) : std::vector<std::size_t>();
}

/// Counts the samples of all topics.
class SampleCounter {
 public:
  SampleCounter(const std::vector<ros::ImageTopic>& topics, const ProgressCall& progress) : progress_(progress) {
    for (const ros::ImageTopic& topic : topics) {
      total_ += samplesOf(topic).size();
    }
    tell();
  }
  void count() {
    ++done_;
    tell();
  }

 private:
  void tell() const {
    if (progress_) {
      progress_(done_, total_);
    }
  }

  const ProgressCall& progress_;
  std::size_t done_ = 0;
  std::size_t total_ = 0;
};

void lookAtSamples(const ros::ImageTopic& topic, const detection::TargetDetector* detector, SampleCounter& counter,
                   CameraInspection& camera) {
  const bool has_sizes = !camera.sizes.empty();
  for (const std::size_t index : samplesOf(topic)) {
    try {
      const cv::Mat gray = topic.load(index);
      if (!has_sizes) {
        ++camera.sizes[{gray.cols, gray.rows}];
      }
      if (!has_sizes || usualSize(camera) == ImageSize(gray.cols, gray.rows)) {
        addSample(gray, topic.images[index].stamp_ns, detector, camera);
      }
    } catch (const InputError& error) {
      camera.unreadable_reason = camera.num_unreadable++ == 0 ? error.what() : camera.unreadable_reason;
    }
    counter.count();
  }
}

/// Damaged messages are skipped, those of another type are not.
std::string refusalOf(const std::string& recording, const std::string& topic) {
  try {
    openRecording(recording, {topic}, {}, [](const std::string& /*warning*/) {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Depth images can be read and show no board.
bool looksLikeDepth(const std::string& topic) { return topic.find("depth") != std::string::npos; }

/// Why a camera does not belong into a calibration; empty where it does.
std::string reasonAgainst(const CameraInspection& camera, bool has_target) {
  if (!camera.is_supported) {
    return "its encoding cannot be used";
  }
  if (camera.samples.empty()) {
    return "it has no readable images";
  }
  if (!camera.refusal.empty()) {
    return "a calibration refuses it";
  }
  if (has_target) {
    return camera.corners.images.empty() ? "no board was seen" : "";
  }
  return looksLikeDepth(camera.topic) ? "its name says depth" : "";
}

CameraInspection inspectCamera(const std::string& recording, const ros::ImageTopic& topic,
                               const detection::TargetDetector* detector, SampleCounter& counter) {
  CameraInspection camera;
  camera.topic = topic.topic;
  camera.type = topic.type;
  camera.corners.topic = topic.topic;
  camera.num_images = topic.images.size();
  camera.num_unreadable = topic.num_unreadable;
  camera.refusal = topic.num_unreadable > 0 ? refusalOf(recording, topic.topic) : "";
  camera.is_supported = topic.is_supported;
  std::set<std::string> encodings;
  for (const ros::ImageRecord& image : topic.images) {
    encodings.insert(image.encoding);
    if (image.width > 0) {
      ++camera.sizes[{image.width, image.height}];
    }
  }
  camera.encodings.assign(encodings.begin(), encodings.end());
  if (!topic.images.empty()) {
    camera.timing = timingOf(topic.images);
  }
  lookAtSamples(topic, detector, counter, camera);
  camera.left_out = reasonAgainst(camera, detector != nullptr);
  return camera;
}

/// The same camera may be recorded both plain and compressed: one of them is enough.
void leaveOutCopies(std::vector<CameraInspection>& cameras) {
  for (CameraInspection& camera : cameras) {
    const auto is_plain = [&camera](const CameraInspection& other) {
      return other.isUsable() && camera.topic == other.topic + "/compressed";
    };
    if (camera.isUsable() && std::any_of(cameras.begin(), cameras.end(), is_plain)) {
      camera.left_out = "the same images are there without compression";
    }
  }
}

void compareTimes(const ros::BagContents& contents, Inspection& inspection) {
  std::vector<std::int64_t> reference_ns;
  for (std::size_t i = 0; i < inspection.cameras.size(); ++i) {
    if (!inspection.cameras[i].isUsable()) {
      continue;
    }
    const std::vector<std::int64_t> stamps_ns = sortedStamps(contents.image_topics[i].images);
    if (reference_ns.empty()) {
      reference_ns = stamps_ns;
    } else {
      inspection.synchronizations.emplace_back(i, synchronizationOf(reference_ns, stamps_ns));
    }
  }
}

}  // namespace

Inspection inspect(const std::string& recording, const std::optional<target::Target>& target, const ProgressCall& progress) {
  const ros::BagContents contents =
      std::filesystem::is_directory(recording) ? listFolder(recording) : ros::listBag(recording);
  if (contents.image_topics.empty()) {
    std::vector<std::string> names;
    for (const ros::OtherTopic& topic : contents.other_topics) {
      names.push_back(topic.topic + " (" + topic.type + ")");
    }
    throw InputError("bag " + recording + " has no image topics; it has " + (names.empty() ? "no messages" : joined(names)));
  }
  Inspection inspection;
  inspection.recording = recording;
  inspection.target = target;
  inspection.other_topics = contents.other_topics;
  const auto detector = target ? std::make_unique<detection::TargetDetector>(*target) : nullptr;
  SampleCounter counter(contents.image_topics, progress);
  for (const ros::ImageTopic& topic : contents.image_topics) {
    inspection.cameras.push_back(inspectCamera(recording, topic, detector.get(), counter));
  }
  leaveOutCopies(inspection.cameras);
  compareTimes(contents, inspection);
  return inspection;
}

ImageSize usualSize(const CameraInspection& camera) {
  const auto usual = std::max_element(camera.sizes.begin(), camera.sizes.end(),
                                      [](const auto& a, const auto& b) { return a.second < b.second; });
  return usual == camera.sizes.end() ? ImageSize{} : usual->first;
}

}  // namespace tartan_calib::apps
