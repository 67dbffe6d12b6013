#pragma once

#include <concepts>
#include <cstdint>
#include <optional>

#include <ImathVec.h>

#include "scene/camera/opening.h"
#include "scene/shapes/ray.h"
#include "spectral/packet.h"

namespace abbe {

/// The pixels of a film. Positions on it are in pixels from the top left corner of the upright image.
struct FilmGrid {
  int width = 1;
  int height = 1;
  double pixel_pitch = 1;  ///< [m]
};

/// What a lens does to polarised light: for each lane the Jones matrix [[xx, xy], [yx, yy]], over the root of
/// its transmittance for unpolarised light, from the frame of `axis` across the ray of the scene to that of
/// the film, whose x is the picture's right, made perpendicular to the way of the light there. The second
/// axis of each is the way of the light x the first. [Born1999, sec. 10.9]
struct LensJones {
  Imath::V3f axis{0, 0, 0};
  SampledSpectrum xx, xy, yx, yy;
};

/// What each lane of a packet has of its own behind a dispersive lens, before which all of them share one
/// ray. A lane that does not come to the film has the position of another one that does.
struct LaneImages {
  SampledSpectrum x;         ///< Film position,
  SampledSpectrum y;         ///< likewise.
  SampledSpectrum cos_film;  ///< Of the angle of incidence on the film.
  LensJones jones = {};
};

/// By which way light comes through a lens: 0 is that of the image, others are of its ghosts, by their
/// number.
using LensRoute = std::uint32_t;

/// A ray into the scene, at the time asked for. Radiance L along it adds `weight` L to the spectral
/// irradiance at its film position, balanced over the lanes: each would have drawn the ray with a density of
/// its own.
struct CameraRay {
  Ray ray;
  SampledSpectrum weight;  ///< [sr], lane by lane; 0 where the lens lets nothing through.
  float cos_film;          ///< Cosine of the angle of incidence on the film, for responses that depend on it.
  SampledSpectrum lane_pdf{1.0F};         ///< Density of the ray, were the lane the hero, over the hero's.
  std::optional<LaneImages> images = {};  ///< Where the lens displaces lanes.
  LensRoute route = 0;
};

/// A connection from a scene point through the lens to the film. Intensity I [W/sr] leaving the point towards
/// `lens_point` adds `weight` I to the irradiance of the pixel at `film`.
struct CameraConnection {
  Imath::V2f film;
  Imath::V3f lens_point;
  float pdf_position;      ///< Of the lens point, as it was drawn for that scene point [1/m^2].
  SampledSpectrum weight;  ///< [1/m^2], lane by lane.
  float cos_film;
  std::optional<LaneImages> images =
      {};  ///< Where the lens displaces lanes; `film` is then that of one of them.
  LensRoute route = 0;
};

/// A point where light comes into a lens by way of a ghost.
struct GhostEntrance {
  Imath::V3f point;
  Imath::V3f normal;  ///< Outward, unit.
  LensRoute route;
  float pdf;  ///< Of both [1/m^2].
};

/// What a camera sees along a ray that leaves it at an angle theta with its axis or normal, and how densely
/// `sample_ray` draws the ray for a film position uniform over one pixel [Veach1997, sec. 8.3.2]:
///     weight of `sample_ray`     = importance cos(theta) / (pdf_position pdf_direction),
///     weight of `sample_towards` = importance cos(theta) / (pdf_position d^2),
/// d being the distance to the point, and `pdf_position` there the connection's, which is another where the
/// lens point lies before the pupil that it is drawn by. A ray that can leave a single point only has all of
/// its importance there: `pdf_position` is 1, and both it and `importance` count as per point instead of per
/// area.
struct CameraDensity {
  Imath::V2f film;                ///< Where the ray comes from.
  SampledSpectrum importance;     ///< Irradiance of the pixel per flux along the ray [1/m^2].
  float pdf_position;             ///< Of the point where it leaves the lens or the meter [1/m^2].
  SampledSpectrum pdf_direction;  ///< Of its direction from there [1/sr].
  float cos_theta;
  float cos_film;  ///< Of the angle of incidence on the film.
  std::optional<LaneImages> images =
      {};  ///< Where the lens displaces lanes; `film` is then that of one of them.
};

/// Where the lanes of a ray, connection or density fall, if the lens displaces them.
template <typename Of>
[[nodiscard]] const LaneImages* images_of(const Of& of) {
  return of.images ? &*of.images : nullptr;
}

/// What can be told of a camera without a ray.
struct CameraTraits {
  /// Rays leave an opening all over, so that a lens point has to be drawn, and what is out of focus is
  /// blurred.
  bool depth_of_field = false;
  /// Wavelengths of a ray of the scene fall on film positions of their own, which rays, connections and
  /// densities then tell.
  bool displaces_lanes = false;
  /// Light comes by ways other than that of the image too.
  bool ghosts = false;
  /// The lens changes how light is polarised.
  bool polarises = false;
  std::optional<double> image_distance = {};  ///< Film behind a lens to it [m].
  /// Film of the pinhole whose image is as large as that of a lens of surfaces, to it [m].
  std::optional<double> pinhole_distance = {};
  std::optional<double> f_number = {};  ///< Finite; of the opening, without the losses of the lens.
  std::optional<Imath::V3d> axis = {};  ///< Unit direction in which a lens looks.
  /// Of a meter, which takes light itself: the sine of the greatest angle with its normal that counts. Light
  /// is then connected to it as to a surface, and `sample_towards` connects nothing; every other camera
  /// connects.
  std::optional<float> meter_acceptance = {};
  std::optional<Opening> opening = {};  ///< That rays come in through by themselves, unless it is a point.
};

/// Whether a meter counts what comes from a unit direction, by the part of it across the normal, which keeps
/// its digits where that is small.
[[nodiscard]] inline bool within_acceptance(float acceptance, const Imath::V3f& normal,
                                            const Imath::V3f& direction) {
  const float cos_theta = normal.dot(direction);
  return cos_theta > 0 && (acceptance >= 1 || (direction - normal * cos_theta).length() <= acceptance);
}

/// What a kind of camera has to answer, all of it. Film positions lie within [0, width] x [0, height], the
/// two numbers in [0, 1) pick the lens point (or a meter's direction) uniformly by area, and the time is the
/// share of the exposure that has gone by; see `BasicRay`.
template <typename Model>
concept CameraModel = requires(const Model& camera, Model& movable, const FilmGrid& film, Imath::V2f u,
                               const Ray& ray, const SampledSpectrum& wavelengths_nm, int hero, float time,
                               LensRoute route) {
  /// The ray of a film position, which it is at the hero's wavelength.
  { camera.sample_ray(film, u, u, wavelengths_nm, hero, time) } -> std::same_as<CameraRay>;
  /// From a point to the film; nothing if the point is behind the lens or its image beyond the film.
  {
    camera.sample_towards(film, ray.origin, u, wavelengths_nm, time)
    } -> std::same_as<std::optional<CameraConnection>>;
  /// Of a ray that starts on the lens or the meter and comes by that way; nothing if it comes from beyond the
  /// film.
  { camera.density(film, ray, wavelengths_nm, route) } -> std::same_as<std::optional<CameraDensity>>;
  /// The least cosine of an angle of incidence on the film that rays and connections may report.
  { camera.least_film_cosine(film) } -> std::same_as<double>;
  { camera.traits() } -> std::same_as<CameraTraits>;
  /// Where a lens has its centre or a meter its corner, and where either has its centre.
  { camera.position() } -> std::same_as<const Imath::V3d&>;
  { camera.middle() } -> std::same_as<Imath::V3d>;
  /// Moves it by a vector [m].
  movable.translate(Imath::V3d());
};

}  // namespace abbe
