#pragma once

#include "scene/camera/model.h"

namespace abbe {

/// A meter of irradiance over a parallelogram (or a point, with zero edges), one patch per pixel: film x runs
/// along `edge_u`, film y along `edge_v`. Its rays are cosine-distributed about the unit `normal`.
struct IrradianceProbe {
  Imath::V3d corner{0, 0, 0};
  Imath::V3d edge_u{0, 0, 0};
  Imath::V3d edge_v{0, 0, 0};
  Imath::V3d normal{0, 0, 1};

  [[nodiscard]] CameraRay sample_ray(const FilmGrid& grid, Imath::V2f film, Imath::V2f direction,
                                     const SampledSpectrum& wavelengths_nm, int hero, float time) const;
  [[nodiscard]] std::optional<CameraConnection> sample_towards(const FilmGrid& grid, const Imath::V3f& point,
                                                               Imath::V2f lens,
                                                               const SampledSpectrum& wavelengths_nm,
                                                               float time) const;
  /// The film position of a point meter is the middle of the film, wherever it was drawn.
  [[nodiscard]] std::optional<CameraDensity> density(const FilmGrid& grid, const Ray& ray,
                                                     const SampledSpectrum& wavelengths_nm,
                                                     LensRoute route) const;
  [[nodiscard]] double least_film_cosine(const FilmGrid& grid) const;
  [[nodiscard]] CameraTraits traits() const;
  [[nodiscard]] const Imath::V3d& position() const { return corner; }
  [[nodiscard]] Imath::V3d middle() const { return corner + (edge_u + edge_v) * 0.5; }
  void translate(const Imath::V3d& by) { corner += by; }
};
static_assert(CameraModel<IrradianceProbe>);

}  // namespace abbe
