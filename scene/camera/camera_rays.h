#pragma once

#include <span>

#include "scene/camera/camera.h"

namespace abbe {

/// Arguments of `CameraModel::sample_ray`.
struct CameraSample {
  Imath::V2f film;  ///< Film position [pixels] from the top left corner.
  Imath::V2f lens;  ///< Two random numbers in [0, 1).
  SampledSpectrum wavelengths_nm;
  int hero = 0;    ///< Index of the hero in `wavelengths_nm`.
  float time = 0;  ///< Fraction of the exposure.
};

/// Calls `sample_ray` for each sample, at lower cost for a lens system. `rays` has as many elements as
/// `samples`. The origin, direction and time of a ray of zero weight are arbitrary.
void sample_rays(const Camera& camera, std::span<const CameraSample> samples, std::span<CameraRay> rays);
/// The overload for a lens system at rest; rays keep their times.
void sample_rays(const LensSystem& camera, const FilmGrid& grid, std::span<const CameraSample> samples,
                 std::span<CameraRay> rays);

}  // namespace abbe
