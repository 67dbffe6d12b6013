#pragma once

#include <optional>
#include <variant>

#include <ImathVec.h>

#include "scene/shapes/ray.h"

namespace abbe {

/// Where a camera stands: `right`, `up` and `forward` are orthonormal.
struct CameraFrame {
  Imath::V3d position{0, 0, 0};
  Imath::V3d right{1, 0, 0};
  Imath::V3d up{0, 1, 0};
  Imath::V3d forward{0, 0, 1};
};

/// The film behind a lens: image distance and pixel size fix the field of view, the aperture the exposure.
struct LensCamera {
  CameraFrame frame;
  double image_distance = 0;   ///< Lens to film [m].
  double focus_distance = 0;   ///< Lens to the plane in focus [m]; infinite for a pinhole.
  double aperture_radius = 0;  ///< Radius of the lens opening [m]; a pinhole's is its nominal one, for
                               ///< exposure only.
  bool pinhole = true;
  double transmittance = 1;  ///< Share of the light that the lens passes, at all wavelengths.
};

/// A meter of irradiance over a parallelogram (or a point, with zero edges), one patch per pixel: film x runs
/// along `edge_u`, film y along `edge_v`. Its rays are cosine-distributed about the unit `normal`.
struct IrradianceProbe {
  Imath::V3d corner{0, 0, 0};
  Imath::V3d edge_u{0, 0, 0};
  Imath::V3d edge_v{0, 0, 0};
  Imath::V3d normal{0, 0, 1};
};

/// What turns film positions into rays. Film positions are in pixels from the top left corner of the upright
/// image.
struct Camera {
  std::variant<LensCamera, IrradianceProbe> kind;
  int width = 1;
  int height = 1;
  double pixel_pitch = 1;  ///< [m]

  [[nodiscard]] bool is_probe() const { return kind.index() == 1; }
  /// Sees through one point: no lens point has to be drawn.
  [[nodiscard]] bool is_pinhole() const { return kind.index() == 0 && std::get<LensCamera>(kind).pinhole; }
};

/// Where a lens has its centre, or a meter its corner.
[[nodiscard]] const Imath::V3d& position(const Camera& camera);
[[nodiscard]] Imath::V3d& position(Camera& camera);
/// Where a lens or a meter has its centre.
[[nodiscard]] Imath::V3d middle(const Camera& camera);

/// A ray into the scene. Radiance L along it adds `weight` L to the spectral irradiance at its film position.
struct CameraRay {
  Ray ray;
  float weight;    ///< [sr]
  float cos_film;  ///< Cosine of the angle of incidence on the film, for responses that depend on it.
};
/// `film` is a position in [0, width] x [0, height], `lens` picks the lens point (or the probe's direction)
/// uniformly by area.
[[nodiscard]] CameraRay sample_ray(const Camera& camera, Imath::V2f film, Imath::V2f lens);

/// The least cosine of an angle of incidence on the film that its rays and connections may report.
[[nodiscard]] double least_film_cosine(const Camera& camera);

/// A connection from a scene point through the lens to the film. Intensity I [W/sr] leaving the point towards
/// `lens_point` adds `weight` I to the irradiance of the pixel at `film`. Nothing if the point is behind the
/// lens or its image beyond the film; never for a probe.
struct CameraConnection {
  Imath::V2f film;
  Imath::V3f lens_point;
  float weight;  ///< [1/m^2]
  float cos_film;
};
[[nodiscard]] std::optional<CameraConnection> sample_towards(const Camera& camera, const Imath::V3f& point,
                                                             Imath::V2f lens);

}  // namespace abbe
