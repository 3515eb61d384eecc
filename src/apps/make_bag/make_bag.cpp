#include "make_bag/make_bag.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "tartan_calib/error.h"
#include "tartan_calib/io/image_folder.h"
#include "tartan_calib/pipeline/camera_stream.h"

namespace tartan_calib::apps {
namespace {

namespace fs = std::filesystem;

/// A camera's images, of which the next one waits to be written.
struct ImageTrack {
  std::string topic;
  pipeline::ImageSource source;
  std::optional<pipeline::StampedImage> next;
};

struct ImuMessage {
  std::string topic;
  ros::ImuSample sample;
};

/// Samples of all `<folder>/imu*.csv` by increasing stamp.
std::vector<ImuMessage> loadImuMessages(const std::string& folder) {
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (path.extension() == ".csv" && path.filename().string().rfind("imu", 0) == 0) {
      paths.push_back(path);
    }
  }
  std::sort(paths.begin(), paths.end());
  std::vector<ImuMessage> messages;
  for (const fs::path& path : paths) {
    for (const ros::ImuSample& sample : loadImuCsv(path.string())) {
      messages.push_back({"/" + path.stem().string(), sample});
    }
  }
  std::stable_sort(messages.begin(), messages.end(),
                   [](const ImuMessage& a, const ImuMessage& b) { return a.sample.stamp_ns < b.sample.stamp_ns; });
  return messages;
}

std::vector<ImageTrack> openTracks(const std::vector<pipeline::CameraStream>& streams) {
  std::vector<ImageTrack> tracks;
  for (const pipeline::CameraStream& stream : streams) {
    tracks.push_back({stream.topic, stream.open(), std::nullopt});
    tracks.back().next = tracks.back().source();
  }
  return tracks;
}

std::size_t numImages(const std::vector<pipeline::CameraStream>& streams) {
  return std::accumulate(streams.begin(), streams.end(), std::size_t{0},
                         [](std::size_t sum, const pipeline::CameraStream& stream) { return sum + stream.num_images; });
}

/// The track with the earliest image; null where all are at their end.
ImageTrack* earliest(std::vector<ImageTrack>& tracks) {
  ImageTrack* result = nullptr;
  for (ImageTrack& track : tracks) {
    if (track.next && (result == nullptr || track.next->stamp_ns < result->next->stamp_ns)) {
      result = &track;
    }
  }
  return result;
}

/// Empty where the image cannot be decoded.
cv::Mat loadOrTell(const pipeline::StampedImage& image, const io::RecordingOptions& options) {
  try {
    return image.load();
  } catch (const InputError& error) {
    io::notify(options, std::string(error.what()) + "; it is left out");
    return {};
  }
}

}  // namespace

BagContents makeBag(const std::string& folder, const std::string& bag_path,
                    const std::function<void(const std::string&)>& notice, const ProgressCall& progress) {
  io::RecordingOptions options;
  options.notice = notice;
  const auto streams = io::openImageFolder(folder, io::imageFolderTopics(folder), options);
  std::vector<ImageTrack> tracks = openTracks(streams);
  const std::vector<ImuMessage> imu = loadImuMessages(folder);
  ros::BagWriter writer(bag_path);
  BagContents contents;
  const auto tell = [&, total = numImages(streams)] {
    if (progress) {
      progress(contents.num_images + contents.num_skipped_images, total);
    }
  };
  const auto write_imu_until = [&](std::int64_t stamp_ns) {
    while (contents.num_imu_samples < imu.size() && imu[contents.num_imu_samples].sample.stamp_ns <= stamp_ns) {
      const ImuMessage& message = imu[contents.num_imu_samples++];
      writer.writeImu(message.topic, message.sample);
    }
  };
  tell();
  while (ImageTrack* track = earliest(tracks)) {
    write_imu_until(track->next->stamp_ns);
    const cv::Mat gray = loadOrTell(*track->next, options);
    if (gray.empty()) {
      ++contents.num_skipped_images;
    } else {
      writer.writeImage(track->topic, track->next->stamp_ns, gray);
      ++contents.num_images;
    }
    track->next = track->source();
    tell();
  }
  write_imu_until(std::numeric_limits<std::int64_t>::max());
  if (contents.num_images == 0) {
    throw InputError("no image in folder " + folder + " can be decoded");
  }
  writer.close();
  return contents;
}

}  // namespace tartan_calib::apps
