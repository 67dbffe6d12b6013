#include "lens/system.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace abbe::lens {
namespace {

using M33d = Imath::M33d;

// Rotation about x, then about the tilted y, for row vectors.
M33d tilted(const Imath::V2d& deg) {
  const double a = deg.x * std::numbers::pi / 180;
  const double b = deg.y * std::numbers::pi / 180;
  const M33d about_x(1, 0, 0, 0, std::cos(a), std::sin(a), 0, -std::sin(a), std::cos(a));
  const M33d about_y(std::cos(b), 0, -std::sin(b), 0, 1, 0, std::sin(b), 0, std::cos(b));
  return about_y * about_x;
}

}  // namespace

bool Surface::displaced() const {
  return decenter_mm != Imath::V2d(0, 0) || tilt_deg != Imath::V2d(0, 0);
}

bool System::displaced() const {
  return std::ranges::any_of(surfaces, &Surface::displaced);
}

System with_round_stop(System system) {
  system.surfaces[system.stop].iris.reset();
  return system;
}

SystemAt::SystemAt(const System& of, double wavelength)
    : system(&of), wavelength_nm(wavelength), n{1}, absorption_per_mm{0}, vertex_z{0} {
  for (const Surface& surface : of.surfaces) {
    n.push_back(surface.behind ? surface.behind->index.n(wavelength) : 1);
    absorption_per_mm.push_back(surface.behind ? surface.behind->index.absorption_per_m(wavelength) * 1e-3
                                               : 0);
    const M33d to_world = tilted(surface.tilt_deg);
    frames.push_back({{surface.decenter_mm.x, surface.decenter_mm.y, vertex_z.back()},
                      to_world,
                      to_world.transposed(),
                      surface.tilt_deg != Imath::V2d(0, 0)});
    vertex_z.push_back(vertex_z.back() + surface.thickness_mm);
  }
}

}  // namespace abbe::lens
