#pragma once

#include <string>
#include <vector>

#include "tartan_calib/io/atomic_file.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::io {

/// Corners as CSV: a line `# cam0 <width> <height> <topic>` per camera, then the header
/// `camera,stamp_ns,corner_id,u_px,v_px,cov_uu,cov_uv,cov_vv,used`, then a line per corner by camera, stamp and id.
/// Pixels to 1e-6. The file is left to the caller to commit.
void writeCorners(const std::vector<pipeline::CameraCorners>& cameras, AtomicFile& file);

/// The same as a file of its own, written whole or not at all.
void saveCorners(const std::string& path, const std::vector<pipeline::CameraCorners>& cameras);

/// Reads what saveCorners wrote; lines may come in any order, cov_* and used may be empty. Throws InputError that names
/// file, line and what was expected.
std::vector<pipeline::CameraCorners> loadCorners(const std::string& path);

/// As loadCorners; `name` stands for the file in messages.
std::vector<pipeline::CameraCorners> parseCorners(const std::string& text, const std::string& name);

}  // namespace tartan_calib::io
