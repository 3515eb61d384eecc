#pragma once

#include <string>
#include <vector>

#include "inspect_bag/inspection.h"

namespace tartan_calib::apps {

/// For people: what is in the recording, camera by camera.
std::string inspectionText(const Inspection& inspection);

/// What would spoil a calibration, each in one line with its remedy.
std::vector<std::string> inspectionWarnings(const Inspection& inspection);

/// `--approx-sync` that joins the images which belong together; empty where the default does.
std::optional<double> neededTolerance_s(const Inspection& inspection);

/// The command that calibrates from this recording; `target_file` stands for a placeholder where it is empty. Empty where no
/// camera can be used.
std::string calibrationCommand(const Inspection& inspection, const std::string& target_file);

/// The corners that were seen, as characters over the image, one line for each row of cells: none '.', few '+', many '#'.
std::vector<std::string> coveragePicture(const pipeline::CameraCorners& corners);

/// Thirds of the image without a corner, in words, the most important first.
std::vector<std::string> emptyThirds(const pipeline::CameraCorners& corners);

}  // namespace tartan_calib::apps
