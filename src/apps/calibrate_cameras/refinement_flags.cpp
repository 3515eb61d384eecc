#include "calibrate_cameras/refinement_flags.h"

#include <initializer_list>
#include <string>

#include "common/program.h"

namespace tartan_calib::apps {
namespace {

using detection::Refinement;

constexpr double kMaxSymmetryWindow = 4.0;
constexpr double kMaxWindowScale = 2.0;
constexpr int kMaxHalfWindow_px = 50;

Refinement refinement(const std::string& name) {
  if (name == "symmetry") {
    return Refinement::kSymmetry;
  }
  if (name == "adaptive") {
    return Refinement::kAdaptive;
  }
  if (name == "fixed") {
    return Refinement::kFixed;
  }
  throw UsageError("--refinement is symmetry, adaptive or fixed, not '" + name + "'");
}

/// A size of another refinement's window would change nothing, which is not what was meant.
void checkBelongs(const Flags& flags, std::initializer_list<const char*> names, bool belongs, const std::string& owner) {
  for (const char* name : names) {
    if (flags.has(name) && !belongs) {
      throw UsageError("--" + std::string(name) + " needs --refinement " + owner);
    }
  }
}

}  // namespace

void applyRefinement(const Flags& flags, detection::RecoveryOptions& recovery) {
  recovery.refinement = refinement(flags.get<std::string>("refinement", "symmetry"));
  checkBelongs(flags, {"symmetry-window"}, recovery.refinement == Refinement::kSymmetry, "symmetry");
  checkBelongs(flags, {"window-scale", "min-resize-window-size", "max-resize-window-size"},
               recovery.refinement == Refinement::kAdaptive, "adaptive");
  recovery.symmetry_window = flags.get("symmetry-window", recovery.symmetry_window);
  if (!(recovery.symmetry_window > 0.0 && recovery.symmetry_window <= kMaxSymmetryWindow)) {
    throw UsageError("--symmetry-window must be above 0 and at most 4; 1 reaches as far as the board is symmetric");
  }
  detection::AdaptiveWindowOptions& window = recovery.adaptive_window;
  window.scale = flags.get("window-scale", window.scale);
  window.min_half_window_px = flags.get("min-resize-window-size", window.min_half_window_px);
  window.max_half_window_px = flags.get("max-resize-window-size", window.max_half_window_px);
  if (!(window.scale > 0.0 && window.scale <= kMaxWindowScale)) {
    throw UsageError("--window-scale must be above 0 and at most 2");
  }
  if (window.min_half_window_px < 1 || window.max_half_window_px > kMaxHalfWindow_px ||
      window.min_half_window_px > window.max_half_window_px) {
    throw UsageError("--min-resize-window-size and --max-resize-window-size must be 1 to 50 pixels, the first the smaller");
  }
}

}  // namespace tartan_calib::apps
