#pragma once

#include <cmath>
#include <memory>
#include <numbers>

#include "lens/paraxial.h"
#include "scene/camera/camera.h"
#include "scene/camera/lens_optics.h"
#include "tests/lens/lenses.h"

namespace abbe::test {

/// A camera at (1, 2, 3) that looks along -y with z up; its film extends 15 degrees from the center to the
/// sides.
inline Camera looking_through(const lens::System& lens, double stop_radius, int side = 400,
                              LensOptics::Ghosts ghosts = LensOptics::Ghosts::left_out) {
  const lens::FirstOrder first = lens::first_order(lens::SystemAt(lens, lens.primary_nm()));
  const double half_field = 15 * std::numbers::pi / 180;
  const FilmGrid grid{side, side, first.focal_length_mm * 1e-3 * std::tan(half_field) * 2 / side};
  return {LensSystem{{{1, 2, 3}, {-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                     std::make_shared<LensOptics>(lens, stop_radius, grid, 400, 700, ghosts),
                     ghosts == LensOptics::Ghosts::enumerated},
          grid.width, grid.height, grid.pixel_pitch};
}

/// Eight wavelengths that glass separates well.
inline SampledSpectrum spread_wavelengths() {
  SampledSpectrum::Values nm;
  for (std::size_t j = 0; j < kLanes; ++j) nm[j] = 420.0F + 35 * static_cast<float>(j);
  return SampledSpectrum(nm);
}

/// Height [mm] above the center of the picture; an object below the axis is imaged there.
inline double height_mm(const Camera& camera, float film_y) {
  return (camera.height / 2.0 - static_cast<double>(film_y)) * camera.pixel_pitch * 1e3;
}
inline double across_mm(const Camera& camera, float film_x) {
  return (static_cast<double>(film_x) - camera.width / 2.0) * camera.pixel_pitch * 1e3;
}

}  // namespace abbe::test
