#include "tartan_calib/io/image_folder.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <system_error>
#include <utility>

#include "tartan_calib/error.h"
#include "tartan_calib/io/gray_image.h"

namespace tartan_calib::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTopicSuffix = "/image_raw";

struct StampedFile {
  std::int64_t stamp_ns = 0;
  fs::path path;
};

bool operator<(const StampedFile& a, const StampedFile& b) {
  return a.stamp_ns != b.stamp_ns ? a.stamp_ns < b.stamp_ns : a.path < b.path;
}

bool isImageFile(const fs::path& path) {
  std::error_code is_missing;
  if (!fs::is_regular_file(path, is_missing)) {
    return false;
  }
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  constexpr std::array<const char*, 5> kExtensions = {".png", ".jpg", ".jpeg", ".bmp", ".pgm"};
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> paths;
  try {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      paths.push_back(entry.path());
    }
  } catch (const fs::filesystem_error& error) {
    throw InputError("cannot read folder " + folder.string() + ": " + error.code().message());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

bool hasImages(const fs::path& folder) {
  const std::vector<fs::path> paths = entries(folder);
  return std::any_of(paths.begin(), paths.end(), isImageFile);
}

/// The stamp that a file is named by; empty where the name is anything but digits.
std::optional<std::int64_t> stampOf(const fs::path& path) {
  constexpr std::size_t kMaxDigits = 18 + 1;  // what an int64 holds up to the year 2262
  const std::string name = path.stem().string();
  if (name.empty() || name.size() > kMaxDigits || name.find_first_not_of("0123456789") != std::string::npos) {
    return std::nullopt;
  }
  try {
    return std::stoll(name);
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
}

std::string topicOf(const std::string& camera) { return "/" + camera + kTopicSuffix; }

std::string cameraName(const std::string& topic) {
  const std::size_t begin = std::min(topic.find_first_not_of('/'), topic.size());
  const std::string suffix = kTopicSuffix;
  const std::size_t length = topic.size() - begin;
  const bool has_suffix = length > suffix.size() && topic.compare(topic.size() - suffix.size(), suffix.size(), suffix) == 0;
  return topic.substr(begin, has_suffix ? length - suffix.size() : length);
}

std::vector<StampedFile> listImages(const fs::path& folder, const std::string& topic, const RecordingOptions& options) {
  std::vector<StampedFile> files;
  std::vector<fs::path> unnamed;
  for (const fs::path& path : entries(folder)) {
    if (isImageFile(path)) {
      const std::optional<std::int64_t> stamp_ns = stampOf(path);
      stamp_ns ? files.push_back({*stamp_ns, path}) : unnamed.push_back(path);
    }
  }
  if (files.empty() && !unnamed.empty()) {
    throw InputError("no image in folder " + folder.string() + " has a stamp in nanoseconds for a name (as " +
                     unnamed.front().filename().string() + " has not)");
  }
  if (!unnamed.empty()) {
    notify(options, "topic " + topic + ": " + std::to_string(unnamed.size()) +
                        " images are left out, as their names are not stamps in nanoseconds (first: " +
                        unnamed.front().filename().string() + ")");
  }
  std::sort(files.begin(), files.end());
  return files;
}

TopicStamps stampsOf(const std::vector<StampedFile>& files, const std::string& topic) {
  TopicStamps stamps{topic, {}};
  stamps.stamps_ns.reserve(files.size());
  for (const StampedFile& file : files) {
    stamps.stamps_ns.push_back(file.stamp_ns);
  }
  return stamps;
}

std::vector<StampedFile> only(const std::vector<StampedFile>& files, const std::vector<std::size_t>& images) {
  std::vector<StampedFile> result;
  result.reserve(images.size());
  for (const std::size_t i : images) {
    result.push_back(files[i]);
  }
  return result;
}

InputError noSuchTopic(const std::string& folder, const std::string& topic, const std::vector<std::string>& known) {
  std::string list;
  for (const std::string& name : known) {
    list += (list.empty() ? "" : ", ") + name;
  }
  return InputError("folder " + folder + " has no images for topic " + topic + "; its image topics: " + list);
}

cv::Mat readGray(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  try {
    return decodeGray(bytes);
  } catch (const InputError& error) {
    throw InputError("image " + path.string() + ": " + error.what());
  }
}

pipeline::ImageSource imageSource(std::shared_ptr<const std::vector<StampedFile>> files) {
  return [files = std::move(files), next = std::size_t{0}]() mutable {
    std::optional<pipeline::StampedImage> image;
    if (next < files->size()) {
      const StampedFile& file = (*files)[next++];
      image.emplace();
      image->stamp_ns = file.stamp_ns;
      image->load = [path = file.path] { return toGray8(readGray(path), PixelLayout::kGray); };
    }
    return image;
  };
}

/// Says how 16-bit images are treated, from the topic's first readable one.
void tellOfReduction(const std::vector<StampedFile>& files, const std::string& topic, const RecordingOptions& options) {
  for (const StampedFile& file : files) {
    try {
      return notifyOfReduction(options, topic, readGray(file.path));
    } catch (const InputError&) {
      // Counted where the image is asked for.
    }
  }
}

}  // namespace

std::vector<std::string> imageFolderTopics(const std::string& folder) {
  std::vector<std::string> names;
  for (const fs::path& path : entries(folder)) {
    if (fs::is_directory(path) && hasImages(path)) {
      names.push_back(path.filename().string());
    }
  }
  if (names.empty()) {
    throw InputError("folder " + folder + " has no subfolder with images, such as cam0/<stamp in nanoseconds>.png");
  }
  std::stable_sort(names.begin(), names.end(),
                   [](const std::string& a, const std::string& b) { return a.size() < b.size(); });
  std::transform(names.begin(), names.end(), names.begin(), topicOf);
  return names;
}

std::vector<pipeline::CameraStream> openImageFolder(const std::string& folder, const std::vector<std::string>& topics,
                                                    const RecordingOptions& options) {
  checkOptions(options);
  const std::vector<std::string> known = imageFolderTopics(folder);
  std::vector<std::vector<StampedFile>> files;
  std::vector<TopicStamps> stamps;
  for (const std::string& asked : topics) {
    const std::string camera = cameraName(asked);
    const std::string topic = topicOf(camera);
    if (std::find(known.begin(), known.end(), topic) == known.end()) {
      throw noSuchTopic(folder, asked, known);
    }
    files.push_back(listImages(fs::path(folder) / camera, topic, options));
    stamps.push_back(stampsOf(files.back(), topic));
  }
  const std::vector<std::vector<std::size_t>> selected = selectImages(stamps, options);

  std::vector<pipeline::CameraStream> streams;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const auto wanted = std::make_shared<const std::vector<StampedFile>>(only(files[i], selected[i]));
    tellOfReduction(*wanted, stamps[i].topic, options);
    streams.push_back({stamps[i].topic, wanted->size(), [wanted] { return imageSource(wanted); }});
  }
  return streams;
}

}  // namespace tartan_calib::io
