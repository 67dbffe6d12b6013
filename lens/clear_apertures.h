#pragma once

#include "lens/spectral_system.h"

namespace abbe::lens {

/// The system with a clear aperture at every surface. Surfaces without one get the smallest that transmits
/// all light to an image with these half sides [mm], at `low_nm`, `high_nm` and the wavelength midway. Stops
/// with blades count as their circle. A surface without light gets 0. Throws Error{scene} if the passing rays
/// have no bound.
[[nodiscard]] System with_clear_apertures(const SpectralSystem& system, const Imath::V2d& half_image_mm,
                                          double low_nm, double high_nm);

}  // namespace abbe::lens
