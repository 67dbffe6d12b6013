#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <variant>

#include <ImathVec.h>

#include "lens/iris.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"
#include "spectral/sampled_spectrum.h"

namespace abbe {

/// A planar opening in render coordinates [m]: the points center + a u + b v. A round one has a^2 + b^2 <= 1,
/// otherwise |a|, |b| <= 1. With an iris, (a, b) must also lie inside its polygon.
struct FlatOpening {
  Imath::V3d center;
  Imath::V3d u, v;    ///< Half extents; not parallel, and perpendicular to `normal`.
  Imath::V3d normal;  ///< Unit vector towards the side from which light is received.
  bool round;
  std::optional<lens::Iris> iris = {};
};

/// One side of a sphere, which receives light.
struct SphereSide {
  Sphere sphere;
  bool inwards = false;  ///< True if the sphere receives light from inside, false from outside.
};

/// A surface through which light enters a camera or on which it is received.
using Opening = std::variant<FlatOpening, SphereSide>;

/// Distance > 0 [m] along a light ray, which travels towards the opening, to its intersection with it from
/// the receiving side. Nothing if it misses. The ray's `t_max` is ignored.
[[nodiscard]] std::optional<double> crossing(const Opening& opening, const Ray& ray);
/// Upper bound of the distance [m] of the opening's points from its center.
[[nodiscard]] double opening_radius(const Opening& opening);

/// The pixels of a film. Film positions are in pixels from the top left corner of the upright image: x to the
/// right, y down.
struct FilmGrid {
  int width = 1;
  int height = 1;
  double pixel_pitch = 1;  ///< [m]
};

/// A film position, and what is sampled besides it.
struct CameraSample {
  Imath::V2f film;  ///< Film position [pixels] from the top left corner.
  Imath::V2f lens;  ///< Two random numbers in [0, 1).
  SampledSpectrum wavelengths_nm;
  int hero = 0;    ///< Index of the hero in `wavelengths_nm`.
  float time = 0;  ///< Fraction of the exposure.
};

/// Effect of a lens on polarised light: per wavelength the Jones matrix [[xx, xy], [yx, yy]], divided by the
/// square root of the transmittance for unpolarised light. It maps from the frame of `axis`, which is
/// perpendicular to the ray in the scene, to the frame of the film. The latter's x axis is the picture's
/// right, made perpendicular to the propagation direction there. The second axis of each frame is the
/// propagation direction x its first axis. [Born1999, sec. 10.9]
struct LensJones {
  Imath::V3f axis{0, 0, 0};
  SampledSpectrum xx, xy, yx, yy;
};

/// Film positions of the wavelengths of one scene ray, which a dispersive lens separates. A wavelength that
/// does not arrive has the position of one that does.
struct WavelengthImages {
  SampledSpectrum x;         ///< Film position [pixels].
  SampledSpectrum y;         ///< Film position [pixels].
  SampledSpectrum cos_film;  ///< Cosine of the angle of incidence on the film.
  LensJones jones = {};
};

/// A route of light through a lens: 0 is that of the image, the others are those of ghosts, by index.
using LensRoute = std::uint32_t;

/// A ray into the scene at the requested time, in render coordinates and of infinite length. Radiance L along
/// it adds `weight` L to the spectral irradiance at its film position. Here the weights are those of the
/// hero's density alone. For the balance heuristic over wavelengths the caller divides by the sum of
/// `lane_pdf`.
struct CameraRay {
  Ray ray;
  SampledSpectrum weight;  ///< [sr] per wavelength; 0 if the lens transmits nothing.
  float cos_film;          ///< Cosine of the angle of incidence on the film, for responses that depend on it.
  /// Density of the ray if the wavelength were the hero, relative to the hero's own; 1 for the hero.
  SampledSpectrum lane_pdf{1.0F};
  std::optional<WavelengthImages> images = {};  ///< Present if the lens displaces wavelengths.
  LensRoute route = 0;
};

/// A connection from a scene point through the lens to the film. Intensity I [W/sr] leaving the point towards
/// `lens_point` adds `weight` I to the irradiance of the pixel at `film`. The caller tests visibility.
struct CameraConnection {
  Imath::V2f film;         ///< Film position [pixels].
  Imath::V3f lens_point;   ///< End of the shadow ray, in render coordinates at the requested time.
  float pdf_position;      ///< Density of the lens point as sampled for that scene point [1/m^2].
  SampledSpectrum weight;  ///< [1/m^2] per wavelength.
  float cos_film;          ///< Cosine of the angle of incidence on the film.
  /// Present if the lens displaces wavelengths; `film` is then the position of one of them.
  std::optional<WavelengthImages> images = {};
  LensRoute route = 0;
};

/// A point at which light enters a lens on the way of a ghost.
struct GhostEntrance {
  Imath::V3f point;
  Imath::V3f normal;  ///< Unit normal towards the scene.
  LensRoute route;    ///< Route of the ghost; not 0.
  float pdf;          ///< Joint density of point and route [1/m^2].
};

/// Response of a camera to a ray that leaves it at the angle theta with its axis or normal. The densities are
/// those of `sample_ray` for a film position uniform over one pixel [Veach1997, sec. 8.3.2]:
///     weight of `sample_ray`     = importance cos(theta) / (pdf_position pdf_direction),
///     weight of `sample_towards` = importance cos(theta) / (pdf_position d^2),
/// where d is the distance to the point. In the second formula `pdf_position` is that of the connection. It
/// differs if the lens point lies in front of the pupil by which it is sampled. If rays leave a single point
/// only, `pdf_position` is 1, and it and `importance` are per point instead of per area.
struct CameraDensity {
  Imath::V2f film;                ///< Film position of the ray.
  SampledSpectrum importance;     ///< Irradiance of the pixel per flux along the ray [1/m^2].
  float pdf_position;             ///< Density of the point where the ray leaves the lens or probe [1/m^2].
  SampledSpectrum pdf_direction;  ///< Density of its direction there [1/sr].
  float cos_theta;                ///< Cosine of theta; positive.
  float cos_film;                 ///< Cosine of the angle of incidence on the film.
  /// Present if the lens displaces wavelengths; `film` is then the position of one of them.
  std::optional<WavelengthImages> images = {};
};

/// The film positions of the wavelengths of a `CameraRay`, `CameraConnection` or `CameraDensity`, which owns
/// them; nullptr if the lens does not displace them.
template <typename Of>
[[nodiscard]] const WavelengthImages* images_of(const Of& of) {
  return of.images ? &*of.images : nullptr;
}

/// Properties of a camera that do not depend on a ray.
struct CameraTraits {
  /// Rays leave an extended opening, so that a lens point must be sampled and out-of-focus objects are
  /// blurred.
  bool depth_of_field = false;
  /// Each wavelength of a scene ray has its own film position, which rays, connections and densities contain.
  bool displaces_wavelengths = false;
  /// Light arrives by routes of ghosts too.
  bool ghosts = false;
  /// The lens changes the state of polarisation.
  bool polarises = false;
  std::optional<double> image_distance = {};  ///< Distance from the film to the lens [m].
  /// Distance [m] from the film to the pinhole that would give an image as large as that of a lens system.
  std::optional<double> pinhole_distance = {};
  std::optional<double> f_number = {};  ///< Finite f-number of the opening, without the losses of the lens.
  std::optional<Imath::V3d> axis = {};  ///< Unit viewing direction of a camera with a lens.
  /// Acceptance of a probe: the sine of the maximum angle with its normal at which light counts. Light is
  /// connected to a probe as to a surface, and `sample_towards` returns nothing. All other cameras implement
  /// `sample_towards`.
  std::optional<float> probe_acceptance = {};
  std::optional<Opening> opening = {};  ///< The opening that light rays can hit; nothing for a point.
};

/// True if a probe accepts light that arrives from the unit `direction`, which points away from the probe.
/// `acceptance` is the sine of the maximum angle with the unit `normal`, in (0, 1]. The test uses the
/// direction's component perpendicular to the normal, which is precise for small angles.
[[nodiscard]] inline bool within_acceptance(float acceptance, const Imath::V3f& normal,
                                            const Imath::V3f& direction) {
  const float cos_theta = normal.dot(direction);
  return cos_theta > 0 && (acceptance >= 1 || (direction - normal * cos_theta).length() <= acceptance);
}

/// Requirements on a kind of camera. Film positions lie in [0, width] x [0, height]. The two random numbers
/// in [0, 1) select the lens point uniformly by area, or a probe's direction in proportion to the cosine.
/// `hero` is the index of a wavelength. The time is a fraction of the exposure; see `BasicRay`. Models do not
/// move; they only copy it. None of the functions throws.
template <typename Model>
concept CameraModel = requires(const Model& camera, Model& movable, const FilmGrid& film,
                               const CameraSample& sample, const Ray& ray,
                               const SampledSpectrum& wavelengths_nm, LensRoute route) {
  /// Samples the ray of a film position; with a dispersive lens it is that of the hero wavelength.
  { camera.sample_ray(film, sample) } -> std::same_as<CameraRay>;
  /// Connects a point to the film, whatever `sample.film` and `sample.hero`. Nothing if the point is behind
  /// the lens, its image falls outside the film or the lens blocks the ray, and for probes always.
  { camera.sample_towards(film, ray.origin, sample) } -> std::same_as<std::optional<CameraConnection>>;
  /// Density of a ray that starts on the lens or probe, leads into the scene and takes that route. Nothing if
  /// `sample_ray` cannot produce it: its film position is outside the film, it leads backwards, the lens
  /// blocks it, or a probe does not accept it.
  { camera.density(film, ray, wavelengths_nm, route) } -> std::same_as<std::optional<CameraDensity>>;
  /// Lower bound of the cosine of the angle of incidence on the film over all rays and connections.
  { camera.min_film_cosine(film) } -> std::same_as<double>;
  { camera.traits() } -> std::same_as<CameraTraits>;
  /// `position` [m]: center of an ideal lens, first vertex of a lens system, corner of a quad probe, or
  /// center of another probe. `center` [m]: center of the points from which rays start.
  { camera.position() } -> std::same_as<const Imath::V3d&>;
  { camera.center() } -> std::same_as<Imath::V3d>;
  /// Moves the camera by a vector [m].
  movable.translate(Imath::V3d());
};

/// Position [m] and orientation of a camera in render coordinates. `forward` is the unit viewing direction
/// into the scene. `right` and `up` are unit vectors along the picture's right and up. The scene file's
/// cameras have `up` = `right` x `forward`; the default values do not.
struct CameraFrame {
  Imath::V3d position{0, 0, 0};
  Imath::V3d right{1, 0, 0};
  Imath::V3d up{0, 1, 0};
  Imath::V3d forward{0, 0, 1};
};

}  // namespace abbe
