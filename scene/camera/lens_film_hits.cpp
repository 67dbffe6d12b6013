#include "scene/camera/lens_film_hits.h"

#include <array>
#include <bit>

#include "materials/bsdf/warp.h"
#include "scene/camera/lens_optics.h"
#include "scene/camera/perspective.h"

// The densities p_j are those defined in `lens_system.cpp`.

namespace abbe {
namespace {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using lens::kMmPerM;

// The hit of one wavelength on the film.
struct FilmHit {
  V2f film;
  double cos_film;
  double pdf;  // p_j [1/sr]
};

// Pdf of the direction of a wavelength from the lens to a film point. Nothing if the image's route would not
// sample it, outside the bound of the exit pupil.
std::optional<double> exit_pdf(const LensOptics& optics, const V2d& image, const V3d& d) {
  const double depth = optics.system.image_z() - optics.system.last_z();
  const lens::PupilBound bound = optics.pupil.bound(image);
  if (!bound.contains(image - V2d(d.x, d.y) * (depth / d.z))) return std::nullopt;
  const double cos2 = d.z * d.z;
  return depth * depth / (bound.area() * cos2 * cos2);
}

// Pdf of that direction for the route of a ghost, from a point of the last surface.
double ghost_exit_pdf(const LensOptics& optics, const V2d& image, const V3d& d, const V3d& last) {
  const std::size_t surface = optics.last_surface();
  const lens::SurfacePoint at = optics.system.point_of(surface, optics.system.local_of(surface, last));
  const double distance2 = (V3d(image.x, image.y, optics.system.image_z()) - last).length2();
  return at.cos_axis * distance2 / (disc_area(optics.semi_aperture_mm(surface)) * d.z * at.normal.dot(d));
}

// The film hit of one wavelength; nothing if it does not arrive or would not be sampled.
std::optional<FilmHit> landing(const LensSystem& camera, const FilmGrid& grid,
                               const lens::BasicImageRay<lens::Floats>& arrival, LensRoute route, int lane) {
  if (!arrival.reached_image[lane]) return std::nullopt;
  const V2d point(V2f(arrival.point.x[lane], arrival.point.y[lane]));
  const auto film = film_position(grid, -point / kMmPerM);
  if (!film) return std::nullopt;
  const V3d d(lane_of(arrival.direction, lane));
  const LensOptics& optics = *camera.optics;
  const auto pdf = route == 0 ? exit_pdf(optics, point, d)
                              : ghost_exit_pdf(optics, point, d, V3d(lane_of(arrival.last, lane)));
  if (!pdf) return std::nullopt;
  return FilmHit{*film, d.z, route_probability(camera, route) * *pdf};
}

// Spectrum of the first or the second packet.
SampledSpectrum spectrum(const lens::Floats& lanes, std::size_t packet) {
  return std::bit_cast<std::array<SampledSpectrum, 2>>(lanes)[packet];
}

// Jones matrices from the fields behind the lens of incident fields along the first axis, in the scene, and
// along the second; 0 for wavelengths that do not arrive.
std::array<LensJones, 2> jones(const std::array<V3f, 2>& axes,
                               const lens::BasicImageRay<lens::Floats>& arrival) {
  using Lanes = Imath::Vec3<lens::Floats>;
  const lens::Floats power = arrival.first.dot(arrival.first) + arrival.second.dot(arrival.second);
  const lens::Floats over_root = 1 / sqrt(select(power > 0, power * 0.5, 1));
  const Lanes y = lens::unit(arrival.direction.cross(Lanes(1, 0, 0)));  // x is the picture's right
  const Lanes x = y.cross(arrival.direction);
  const auto element = [&](const Lanes& to, const Lanes& field) {
    return select(arrival.reached_image, to.dot(field) * over_root, 0);
  };
  const lens::Floats xx = element(x, arrival.first);
  const lens::Floats xy = element(x, arrival.second);
  const lens::Floats yx = element(y, arrival.first);
  const lens::Floats yy = element(y, arrival.second);
  const auto of = [&](std::size_t packet) {
    return LensJones{axes[packet], spectrum(xx, packet), spectrum(xy, packet), spectrum(yx, packet),
                     spectrum(yy, packet)};
  };
  return {of(0), of(1)};
}

}  // namespace

V3d to_lens(const CameraFrame& frame, const V3d& v) {
  return {v.dot(frame.right), v.dot(frame.up), -v.dot(frame.forward)};
}
V3d from_lens(const CameraFrame& frame, const V3d& v) {
  return frame.right * v.x + frame.up * v.y - frame.forward * v.z;
}

double route_probability(const LensSystem& camera, LensRoute route) {
  return camera.ghosts ? camera.optics->route_probability[route] : 1;
}

namespace {

lens::Ray towards_film(const LensSystem& camera, const Ray& ray) {
  return {to_lens(camera.frame, V3d(ray.origin) - camera.frame.position) * kMmPerM,
          -to_lens(camera.frame, V3d(ray.direction)).normalized()};
}

// Film hits of the first or the second packet, without polarisation.
std::optional<FilmHits> landings(const LensSystem& camera, const FilmGrid& grid,
                                 const lens::BasicImageRay<lens::Floats>& arrival, LensRoute route,
                                 std::size_t packet) {
  std::array<std::optional<FilmHit>, kLanes> lanes;
  const FilmHit* any = nullptr;
  for (std::size_t j = 0; j < kLanes; ++j) {
    lanes[j] = landing(camera, grid, arrival, route, static_cast<int>(packet * kLanes + j));
    if (lanes[j] && any == nullptr) any = &*lanes[j];
  }
  if (any == nullptr) return std::nullopt;
  std::array<SampledSpectrum::Values, 4> of{};
  SampledSpectrum::Values drawn{};
  for (std::size_t j = 0; j < kLanes; ++j) {
    const FilmHit& lane = lanes[j] ? *lanes[j] : *any;
    of[0][j] = lane.film.x;
    of[1][j] = lane.film.y;
    of[2][j] = static_cast<float>(lane.cos_film);
    if (!lanes[j]) continue;
    of[3][j] = static_cast<float>(lane.pdf);
    drawn[j] = 1;
  }
  const SampledSpectrum transmittance =
      SampledSpectrum::map(spectrum(arrival.transmittance, packet), SampledSpectrum(drawn),
                           [](float passes, float there) { return there > 0 ? passes : 0; });
  return FilmHits{{SampledSpectrum(of[0]), SampledSpectrum(of[1]), SampledSpectrum(of[2])},
                  transmittance,
                  SampledSpectrum(of[3])};
}

}  // namespace

std::array<std::optional<FilmHits>, 2> trace_pair_to_film(const LensSystem& camera, const FilmGrid& grid,
                                                          const std::array<SceneRay, 2>& rays,
                                                          LensRoute route) {
  const lens::Ray first = towards_film(camera, rays[0].ray);
  const lens::Ray second = towards_film(camera, rays[1].ray);
  const auto arrival = camera.optics->system.to_image(
      {{{first, rays[0].wavelengths_nm}, {second, rays[1].wavelengths_nm}}}, camera.optics->routes[route]);
  const auto axis = [&](const lens::Ray& ray) {
    return V3f(from_lens(camera.frame, lens::UnpolarisedFields<double>(ray.direction).first()));
  };
  const std::array<LensJones, 2> matrices = jones({axis(first), axis(second)}, arrival);
  std::array<std::optional<FilmHits>, 2> landed;
  for (std::size_t packet : {0U, 1U}) {
    landed[packet] = landings(camera, grid, arrival, route, packet);
    if (landed[packet]) landed[packet]->images.jones = matrices[packet];
  }
  return landed;
}

}  // namespace abbe
