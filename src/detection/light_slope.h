#pragma once

namespace tartan_calib::detection {

/// Linear change of light, relative, that is usual within a window; keeps the estimate still where the window is dark.
inline constexpr double kLightSlopeSigmaPerPx = 0.01;
inline constexpr double kGraySigmaFloor = 0.5;  ///< of the noise that it is weighed against [grey levels]
/// What to add to the normal equations of a slope of light in a window.
inline constexpr double kLightSlopePrior =
    (kGraySigmaFloor / kLightSlopeSigmaPerPx) * (kGraySigmaFloor / kLightSlopeSigmaPerPx);

}  // namespace tartan_calib::detection
