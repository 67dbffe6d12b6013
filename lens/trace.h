#pragma once

#include <vector>

#include "lens/crossing.h"

namespace abbe::lens {

/// Reason for the end of a ray.
enum class RayEnd {
  image,             ///< It arrived in the image plane.
  missed,            ///< It does not intersect a surface.
  total_reflection,  ///< It cannot leave the glass.
  stopped            ///< It is outside the clear aperture of a surface.
};

/// Treatment of clear apertures.
enum class Apertures { obeyed, ignored };

/// Path of a ray, in double precision.
struct RayPath {
  RayEnd end = RayEnd::image;
  std::size_t at = 0;         ///< Index of the surface where it ended; the number of surfaces at the image.
  std::vector<RayHit> hits;   ///< Hits on the passed surfaces.
  Ray last;                   ///< Ray from its last point, which is on the image if it arrived.
  double last_length_mm = 0;  ///< Distance from the last surface to the image.

  [[nodiscard]] bool reached() const { return end == RayEnd::image; }
};

/// Traces a ray through the first `surfaces` surfaces, and to the image if these are all [Welford1986].
[[nodiscard]] RayPath trace(const SystemAt& at, const Ray& ray, Apertures apertures, std::size_t surfaces);
[[nodiscard]] RayPath trace(const SystemAt& at, const Ray& ray, Apertures apertures);

/// Converts a point to the coordinates of a surface.
[[nodiscard]] Imath::V3d local_point(const SystemAt& at, std::size_t surface, const Imath::V3d& point);

/// Fraction of the power of unpolarised light transmitted along a traced path, by surfaces
/// (`UnpolarisedFields`) and by absorption in glass.
[[nodiscard]] double transmittance(const SystemAt& at, const Ray& start, const RayPath& path);

/// Reason for the end of a ray, as a clause such as "misses surface 3".
[[nodiscard]] std::string reason(const RayPath& path);

}  // namespace abbe::lens
