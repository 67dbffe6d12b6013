#pragma once

#include <span>

#include "scene/camera/camera.h"

namespace abbe {

/// Arguments of `CameraModel::sample_ray`.
struct CameraSample {
  Imath::V2f film;
  Imath::V2f lens;
  SampledSpectrum wavelengths_nm;
  int hero = 0;
  float time = 0;
};

/// Calls `sample_ray` for each sample, at lower cost for a lens system. `rays` has as many elements as
/// `samples`. A ray of zero weight is arbitrary.
void sample_rays(const Camera& camera, std::span<const CameraSample> samples, std::span<CameraRay> rays);
/// The overload for a lens system at rest.
void sample_rays(const LensSystem& camera, const FilmGrid& grid, std::span<const CameraSample> samples,
                 std::span<CameraRay> rays);

}  // namespace abbe
