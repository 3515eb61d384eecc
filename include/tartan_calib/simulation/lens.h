#pragma once

#include <cstdint>
#include <string>

#include "tartan_calib/simulation/scene.h"

namespace tartan_calib::simulation {

/// A lens to be simulated.
struct LensRequest {
  /// `bf5m195` (like a Lensagon BF5M: 195 degrees, 1224x1024), `gopro150` (like a GoPro Hero 8: 123 degrees across, 149
  /// along the diagonal, 1280x960), or any `fisheye<degrees>` or `pinhole<degrees>`, of that horizontal field of view.
  std::string lens = "fisheye190";
  std::string model = "ds-none";  ///< as camera::modelNames; takes the lens' shape as well as it can and is then the truth
  int width = 0;                  ///< [px]; 0: the lens' own
  int height = 0;
};

/// The lens in the origin of the rig. Throws InputError for a lens that is not known and for a model that cannot show its
/// field of view.
SceneCamera makeLens(const LensRequest& request);

/// The same type of lens as another piece from the production: focal lengths, principal point and image circle differ a bit.
SceneCamera anotherPiece(const SceneCamera& lens, std::uint64_t seed);

}  // namespace tartan_calib::simulation
