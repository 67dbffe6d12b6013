#pragma once

#include <optional>
#include <span>
#include <vector>

#include <ImathVec.h>

#include "lens/beam.h"

namespace abbe::lens {

/// A ray of a beam in the plane of the image.
struct SpotRay {
  Imath::V2d point;  ///< [mm]
  Imath::V2d slope;  ///< dx/dz and dy/dz.
  double weight;     ///< Power, in units of `Beam::density` times the launch plane's area [mm^2].
};

/// Where the rays of a beam meet the image: even in the launch plane, so that each stands for its power.
struct Spot {
  double wavelength_nm;
  double field;
  std::vector<SpotRay> rays;
  double filled = 0;       ///< Power through the stop, were there no other clear apertures.
  double passed = 0;       ///< Power that reaches the image, surfaces and glass not yet counted.
  double transmitted = 0;  ///< The same times what these let through.

  /// Share of the power through the stop that clear apertures, missed surfaces and total reflection take;
  /// none where no ray was aimed through it.
  [[nodiscard]] std::optional<double> vignetting() const {
    return filled > 0 ? std::optional(1 - passed / filled) : std::nullopt;
  }
};

/// Rays from the middles of `side` times `side` cells of the rectangle around the beam.
[[nodiscard]] Spot spot(const Beam& beam, double field, int side);

/// Size of spots taken together, about their common centroid.
struct SpotSize {
  Imath::V2d centroid;
  double rms_mm;      ///< Root of the mean square distance from the centroid.
  double largest_mm;  ///< Largest distance from it.
};
/// Of no rays nothing.
[[nodiscard]] std::optional<SpotSize> size_of(std::span<const Spot> spots);

/// How far the image must move towards +z for the least sum of the mean squares of groups of spots, each
/// about its own centroid [mm]; nothing where no move changes it, as of parallel rays.
[[nodiscard]] std::optional<double> best_focus(std::span<const std::vector<Spot>> groups);

/// Modulus of the Fourier transform of spots taken together: the geometric modulation transfer of lines
/// across `direction` (unit) at so many per millimetre. Diffraction is left out. Of no rays 0.
[[nodiscard]] double geometric_mtf(std::span<const Spot> spots, double per_mm, const Imath::V2d& direction);

}  // namespace abbe::lens
