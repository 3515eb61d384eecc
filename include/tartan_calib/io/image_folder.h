#pragma once

#include <string>
#include <vector>

#include "tartan_calib/io/recording.h"
#include "tartan_calib/pipeline/camera_stream.h"

namespace tartan_calib::io {

/// Topics of a folder in kalibr_bagcreater's layout, `<folder>/<camera>/<stamp_ns>.png` (or jpg, jpeg, bmp, pgm): one topic
/// `/<camera>/image_raw` for each subfolder with images, cam2 before cam10. Throws InputError where the folder has none.
std::vector<std::string> imageFolderTopics(const std::string& folder);

/// Opens topics of such a folder; `/<camera>` stands for `/<camera>/image_raw`. Files whose names are no stamps are left out
/// and told of. Throws InputError for a topic without a subfolder or without images.
std::vector<pipeline::CameraStream> openImageFolder(const std::string& folder, const std::vector<std::string>& topics,
                                                    const RecordingOptions& options);

}  // namespace tartan_calib::io
