#pragma once

#include "lens/spectral_system.h"

namespace abbe::lens {

/// The system with a clear aperture at every surface: where it has none, the smallest that lets all light of
/// an image of these half sides [mm] pass, of a stop with blades that of its circle, at wavelengths between
/// the ends of the range. Throws what `search_pupil` does.
[[nodiscard]] System with_clear_apertures(const SpectralSystem& system, const Imath::V2d& half_image_mm,
                                          double low_nm, double high_nm);

}  // namespace abbe::lens
