#pragma once

#include "lens/spectral_system.h"

namespace abbe::lens {

/// The system with a clear aperture at every surface. Surfaces without one get the smallest that transmits
/// all light to an image with these half sides [mm], for three wavelengths from `low_nm` to `high_nm`. Stops
/// with blades count as their circle. Throws like `search_pupil`.
[[nodiscard]] System with_clear_apertures(const SpectralSystem& system, const Imath::V2d& half_image_mm,
                                          double low_nm, double high_nm);

}  // namespace abbe::lens
