#pragma once

#include <variant>

#include "scene/camera/model.h"
#include "scene/shapes/shape.h"

namespace abbe {

/// A point [m] that receives light from the side of its unit normal.
struct ProbePoint {
  Imath::V3d at{0, 0, 0};
  Imath::V3d normal{0, 0, 1};
};

/// A surface that receives light without blocking it, from directions within an angle of its normal. Film
/// pixels are patches of equal area; on a quad columns run along `edge_u` and rows along `edge_v`. The film's
/// irradiance is that by the accepted light. Divided by the projected solid angle pi `acceptance`^2 it is the
/// mean radiance, multiplied by the area it is the flux.
struct IrradianceProbe {
  Joined<std::variant<ProbePoint, SphereSide>, FlatShape>::type surface;
  double acceptance = 1;  ///< Sine of the maximum angle with the normal, in (0, 1].

  // Functions without a comment are those of `CameraModel`.

  [[nodiscard]] CameraRay sample_ray(const FilmGrid& grid, const CameraSample& sample) const;
  /// Always nothing: light is connected to a probe as to a surface.
  [[nodiscard]] std::optional<CameraConnection> sample_towards(const FilmGrid& /*grid*/,
                                                               const Imath::V3f& /*point*/,
                                                               const CameraSample& /*sample*/) const {
    return std::nullopt;
  }
  /// The film position of a point probe is the center of the film, whatever position was sampled.
  [[nodiscard]] std::optional<CameraDensity> density(const FilmGrid& grid, const Ray& ray,
                                                     const SampledSpectrum& wavelengths_nm,
                                                     LensRoute route) const;
  [[nodiscard]] double min_film_cosine(const FilmGrid& grid) const;
  [[nodiscard]] CameraTraits traits() const;
  [[nodiscard]] const Imath::V3d& position() const;
  [[nodiscard]] Imath::V3d center() const;
  void translate(const Imath::V3d& by);

  /// Unit normal at a point of the surface, towards the incident light.
  [[nodiscard]] Imath::V3f normal_at(const Imath::V3f& point) const;
  /// Area of the surface [m^2]; 0 for a point.
  [[nodiscard]] double area() const;
};
static_assert(CameraModel<IrradianceProbe>);

}  // namespace abbe
