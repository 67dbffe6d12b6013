#pragma once

#include <variant>

#include "scene/camera/model.h"
#include "scene/shapes/shape.h"

namespace abbe {

/// A point that takes light from the side of its unit normal.
struct PointOfMeter {
  Imath::V3d at{0, 0, 0};
  Imath::V3d normal{0, 0, 1};
};

/// A meter: a surface that light goes through unhindered, which counts what comes within an angle of its
/// normal. Pixels of the film are patches of equal areas, of a quad along `edge_u` and `edge_v`. The film
/// value is the irradiance by the light that counts, so that over the projected solid angle pi
/// `acceptance`^2 it is the mean radiance, and times the area the flux.
struct Probe {
  std::variant<PointOfMeter, Quad, Disc, SphereSide> surface;
  double acceptance = 1;  ///< Sine of the greatest angle with the normal.

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
  [[nodiscard]] const Imath::V3d& position() const;
  [[nodiscard]] Imath::V3d middle() const;
  void translate(const Imath::V3d& by);

  /// The unit normal, on the side that light comes from, at a point of the surface.
  [[nodiscard]] Imath::V3f normal_at(const Imath::V3f& point) const;
  /// Of the surface [m^2]; 0 of a point.
  [[nodiscard]] double area() const;
};
static_assert(CameraModel<Probe>);

}  // namespace abbe
