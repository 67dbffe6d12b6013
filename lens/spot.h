#pragma once

#include <optional>
#include <span>
#include <vector>

#include <ImathVec.h>

#include "lens/beam.h"

namespace abbe::lens {

/// A ray of a beam in the image plane.
struct SpotRay {
  Imath::V2d point;  ///< Position [mm].
  Imath::V2d slope;  ///< Slopes dx/dz and dy/dz.
  double weight;  ///< Power that arrives, after losses, in units of `Beam::density` times mm^2 of the launch
                  ///< plane.
};

/// Intersections of a beam with the image plane. The rays are evenly spaced in the launch plane, so each
/// carries its own power. Powers have the unit of `SpotRay::weight`.
struct Spot {
  double wavelength_nm;
  double field;               ///< Field as defined in `System`.
  std::vector<SpotRay> rays;  ///< Rays that arrive at the image.
  double filled = 0;          ///< Power through the stop without other clear apertures.
  double passed = 0;          ///< Power that arrives at the image without losses in surfaces and glass.
  double transmitted = 0;     ///< Power that arrives at the image with these losses.

  /// Fraction of the power through the stop that is lost at clear apertures, by missed surfaces and by total
  /// reflection. Nothing if no ray passes the stop.
  [[nodiscard]] std::optional<double> vignetting() const {
    return filled > 0 ? std::optional(1 - passed / filled) : std::nullopt;
  }
};

/// Traces rays through the centers of `side` x `side` cells of the beam's bounding rectangle, with clear
/// apertures. `field` is only recorded.
[[nodiscard]] Spot spot(const Beam& beam, double field, int side);

/// Size of several spots about their common centroid, with rays weighted by power.
struct SpotSize {
  Imath::V2d centroid;  ///< Position (x, y) in the image plane [mm].
  double rms_mm;        ///< Root of the mean square distance from the centroid.
  double largest_mm;    ///< Largest distance from the centroid.
};
/// Nothing without rays.
[[nodiscard]] std::optional<SpotSize> size_of(std::span<const Spot> spots);

/// Displacement of the image plane towards +z [mm] that minimises the sum of the mean squares of groups of
/// spots, each about its own centroid. Means are weighted by power. Nothing if the displacement has no
/// effect, as for parallel rays.
[[nodiscard]] std::optional<double> best_focus(std::span<const std::vector<Spot>> groups);

/// Geometric modulation transfer of several spots together: the modulus of their Fourier transform for a
/// pattern of `per_mm` cycles per mm that varies along the unit vector `direction`. Ignores diffraction. The
/// result lies in [0, 1]; 0 without rays.
[[nodiscard]] double geometric_mtf(std::span<const Spot> spots, double per_mm, const Imath::V2d& direction);

/// Spots of every field (outer vector) at all wavelengths (inner vector) of the system. The rays of a spot
/// pass the centers of `side` x `side` cells of its beam. A field without a beam (`Beam::of`) has a spot
/// without rays and powers.
[[nodiscard]] std::vector<std::vector<Spot>> all_spots(const System& system, double stop_radius_mm, int side);

/// `best_focus` of the spots of all fields and wavelengths, grouped by field. Throws Error{scene} like
/// `stop_radius`.
[[nodiscard]] std::optional<double> best_focus(const System& system);

}  // namespace abbe::lens
