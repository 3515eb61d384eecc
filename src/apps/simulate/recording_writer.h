#pragma once

#include <memory>
#include <string>

#include "tartan_calib/simulation/renderer.h"

namespace tartan_calib::apps {

/// Takes the images of a rendered recording. Nothing is left behind unless `finish` was called.
class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;
  virtual void write(const simulation::RenderedFrame& frame) = 0;
  virtual void finish() = 0;
};

std::string imageTopic(std::size_t camera_index);

std::unique_ptr<RecordingWriter> makeBagWriter(const std::string& bag_path);

/// Throws InputError where `folder` exists already.
std::unique_ptr<RecordingWriter> makeFolderWriter(const std::string& folder);

}  // namespace tartan_calib::apps
