#pragma once

#include <span>

#include "scene/camera/camera.h"

namespace abbe {

/// What a camera's ray is asked for by: see `CameraModel`.
struct CameraSample {
  Imath::V2f film;
  Imath::V2f lens;
  SampledSpectrum wavelengths_nm;
  int hero = 0;
  float time = 0;
};

/// `sample_ray` for many samples, at less cost where a lens is traced; as many rays. Those that weigh nothing
/// are any.
void sample_rays(const Camera& camera, std::span<const CameraSample> samples, std::span<CameraRay> rays);
/// Those of a lens at rest.
void sample_rays(const LensSystem& camera, const FilmGrid& grid, std::span<const CameraSample> samples,
                 std::span<CameraRay> rays);

}  // namespace abbe
