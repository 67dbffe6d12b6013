#include "lens/field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "lens/paraxial.h"

namespace abbe::lens {
namespace {

using V2d = Imath::V2d;

constexpr double kFirstZeroOfJ1 = 3.8317059702075123;
constexpr double kFieldDifference = 1e-3;  // degrees; for near objects, as seen from the first vertex

std::optional<RayPath> traced(const Beam& beam, const V2d& pupil, Apertures apertures) {
  const auto launched = beam.aim(pupil);
  if (!launched) return std::nullopt;
  RayPath path = trace(beam.at(), beam.launch(*launched), apertures);
  return path.reached() ? std::optional(std::move(path)) : std::nullopt;
}

std::optional<RayPath> chief_path(const SystemAt& at, double field, double stop_radius_mm) {
  const auto beam = Beam::of(at, field, stop_radius_mm);
  return beam ? traced(*beam, {0, 0}, Apertures::ignored) : std::nullopt;
}

// Values for the rays through the right, left, upper and lower edge of the stop.
using Ends = std::array<V2d, 4>;
// Radius of the circle with the area of an ellipse, given the ends of two conjugate diameters.
double mean_radius(const Ends& ends) {
  return std::sqrt(std::abs((ends[0] - ends[1]).cross(ends[2] - ends[3]))) / 2;
}

struct Rim {
  Ends launch_mm;      // points in the launch plane
  Ends image_cosines;  // direction cosines at the image, along x and y
};

std::optional<Rim> rim_of(const Beam& beam) {
  const SystemAt& at = beam.at();
  constexpr std::array<std::array<double, 2>, 4> kEnds{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  Rim rim;
  for (std::size_t i = 0; i < kEnds.size(); ++i) {
    const auto launched = beam.aim({kEnds[i][0], kEnds[i][1]});
    if (!launched) return std::nullopt;
    const RayPath path = trace(at, beam.launch(*launched), Apertures::ignored);
    if (!path.reached()) return std::nullopt;
    rim.launch_mm[i] = *launched;
    rim.image_cosines[i] = {path.last.direction.x, path.last.direction.y};
  }
  return rim;
}

// Ratio of the width of the axial beam in the paraxial entrance pupil to that in the launch plane. Light of
// an object at infinity has the same width everywhere, even in a pupil at infinity. The width is infinite for
// a pupil so far away that its chief rays are parallel to the precision of a prescription. Objects can be
// very close to a lens, so this distance also scales with the length of the lens.
double pupil_over_launch(const SystemAt& at) {
  constexpr double kFar = 1e4;
  const auto& distance = at.system->object_distance_mm;
  if (!distance) return 1;
  const double pupil = first_order(at).entrance_pupil_mm;
  const double length = at.vertex_z[at.size() - 1];
  return std::abs(pupil) < kFar * std::max(*distance, length) ? std::abs(1 + pupil / *distance)
                                                              : std::numeric_limits<double>::infinity();
}

// Fraction of the power through the round stop that arrives at the image. `round` is the spot without blades.
// If nothing else cuts the beam, the area fraction of the iris is exact. The cells of a spot are less
// accurate.
double fraction_at_image(const SystemAt& at, double stop_radius_mm, const Spot& round, int side) {
  const auto& iris = at.surface(at.system->stop).iris;
  if (!iris) return round.transmitted / round.filled;
  if (round.passed == round.filled) return round.transmitted / round.filled * iris->area_fraction();
  const auto beam = Beam::of(at, 0, stop_radius_mm);
  const Spot bladed = spot(*beam, 0, side);
  return bladed.transmitted / bladed.filled;
}

// Reference for the height of the real chief ray `real`.
double ideal_height(const SystemAt& at, double field, const Imath::V3d& real) {
  constexpr double kNear = 0.1;  // of the focal length
  const FirstOrder first = first_order(at);
  const double image = at.system->surfaces.back().thickness_mm;
  const double defocus = image - first.image_distance_mm;
  if (!std::isfinite(defocus) || std::abs(defocus) > kNear * std::abs(first.focal_length_mm))
    return paraxial_chief_height(at, field, image);
  const double in_focus = paraxial_chief_height(at, field, first.image_distance_mm);
  return in_focus != 0 ? in_focus + defocus * real.y / real.z : 0;
}

}  // namespace

std::optional<Speed> speed(const SystemAt& at, double stop_radius_mm, int side) {
  const System round = with_round_stop(*at.system);
  const SystemAt round_at(round, at.wavelength_nm);
  const auto beam = Beam::of(round_at, 0, stop_radius_mm);
  const auto rim = beam ? rim_of(*beam) : std::nullopt;
  if (!rim) return std::nullopt;
  const Spot axial = spot(*beam, 0, side);
  if (!(axial.passed > 0)) return std::nullopt;
  Speed speed{};
  speed.launch_diameter_mm = 2 * mean_radius(rim->launch_mm);
  speed.entrance_diameter_mm = speed.launch_diameter_mm * pupil_over_launch(at);
  speed.f_number = std::isfinite(speed.entrance_diameter_mm)
                       ? std::abs(first_order(at).focal_length_mm) / speed.entrance_diameter_mm
                       : std::numeric_limits<double>::quiet_NaN();
  speed.working_f_number = 1 / (2 * at.n.back() * mean_radius(rim->image_cosines));
  speed.transmittance = axial.transmitted / axial.passed;
  speed.t_stop = speed.f_number / std::sqrt(fraction_at_image(at, stop_radius_mm, axial, side));
  speed.airy_radius_um = kFirstZeroOfJ1 / std::numbers::pi * at.wavelength_nm * 1e-3 * speed.working_f_number;
  return speed;
}

std::optional<RayPath> cut_rim_ray(const SystemAt& at, double stop_radius_mm) {
  constexpr double kRim = 1 - kNominalRounding;  // of the stop's radius
  const auto beam = Beam::of(at, 0, stop_radius_mm);
  if (!beam) return std::nullopt;
  for (const V2d& pupil : {V2d(kRim, 0), V2d(0, kRim), V2d(-kRim, 0), V2d(0, -kRim)}) {
    const auto launched = beam->aim(pupil);
    if (!launched) continue;
    RayPath path = trace(at, beam->launch(*launched), Apertures::obeyed);
    if (!path.reached()) return path;
  }
  return std::nullopt;
}

std::optional<Chief> chief_ray(const SystemAt& at, double field, double stop_radius_mm) {
  const auto path = chief_path(at, field, stop_radius_mm);
  if (!path) return std::nullopt;
  Chief chief{path->last.origin.y, std::nullopt};
  const double ideal = ideal_height(at, field, path->last.direction);
  if (ideal != 0 && std::isfinite(ideal)) chief.distortion = chief.height_mm / ideal - 1;
  return chief;
}

std::optional<double> relative_illumination(const SystemAt& at, double field, double stop_radius_mm,
                                            const Spot& there, const Spot& on_axis) {
  if (at.system->displaced() || !(on_axis.transmitted > 0)) return std::nullopt;
  const auto& distance = at.system->object_distance_mm;
  constexpr double kDegree = std::numbers::pi / 180;
  const double unit = distance ? 1 : kDegree;
  const double h = distance ? *distance * kFieldDifference * kDegree : kFieldDifference;
  std::array<double, 4> y{};  // of the chief rays on both sides of the field point, and of the axis
  const std::array<double, 4> fields{field - h, field + h, -h, h};
  for (std::size_t i = 0; i < y.size(); ++i) {
    const auto path = chief_path(at, fields[i], stop_radius_mm);
    if (!path) return std::nullopt;
    y[i] = path->last.origin.y;
  }
  const double by_field = (y[1] - y[0]) / (2 * h * unit);
  const double by_axis = (y[3] - y[2]) / (2 * h * unit);
  const double power = there.transmitted / on_axis.transmitted;
  if (std::abs(field) < h) return power;
  const double across = distance ? field : std::sin(field * unit);
  return power * across * by_axis * by_axis / ((y[0] + y[1]) / 2 * by_field);
}

RayFan ray_fan(const Beam& beam, const V2d& chief_point, int count) {
  RayFan fan;
  for (int i = 0; i < count; ++i) {
    const double p = count > 1 ? -1 + 2.0 * i / (count - 1) : 0;
    const auto tangential = traced(beam, {0, p}, Apertures::obeyed);
    const auto sagittal = traced(beam, {p, 0}, Apertures::obeyed);
    fan.pupil.push_back(p);
    fan.tangential.push_back(tangential ? std::optional(tangential->last.origin.y - chief_point.y)
                                        : std::nullopt);
    fan.sagittal.push_back(sagittal ? std::optional(sagittal->last.origin.x - chief_point.x) : std::nullopt);
  }
  return fan;
}

}  // namespace abbe::lens
