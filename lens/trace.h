#pragma once

#include <vector>

#include "lens/crossing.h"

namespace abbe::lens {

/// Reason for the end of a ray.
enum class RayEnd {
  image,             ///< It passed all traced surfaces, and arrived in the image plane if these are all.
  missed,            ///< It does not intersect a surface, or does not travel towards the image.
  total_reflection,  ///< A surface reflects it totally.
  stopped            ///< It is outside the clear aperture of a surface.
};

/// Treatment of clear apertures and blades: they block rays, or have no effect.
enum class Apertures { obeyed, ignored };

/// Path of a ray, in double precision and the coordinates of the lens [mm].
struct RayPath {
  RayEnd end = RayEnd::image;
  /// Index of the surface where it ended; the number of traced surfaces if it passed all.
  std::size_t at = 0;
  std::vector<RayHit> hits;   ///< Hits on the passed surfaces, in order.
  Ray last;                   ///< Ray from the last passed surface; from the image if it arrived there.
  double last_length_mm = 0;  ///< Distance from the last surface to the image.

  /// True if no surface ended the ray.
  [[nodiscard]] bool reached() const { return end == RayEnd::image; }
};

/// Traces a ray, which travels towards +z and may start anywhere on its line, by refraction [Welford1986]. It
/// passes the first `surfaces` surfaces, and continues to the image if these are all. The overload without
/// `surfaces` traces all.
[[nodiscard]] RayPath trace(const SystemAt& at, const Ray& ray, Apertures apertures, std::size_t surfaces);
[[nodiscard]] RayPath trace(const SystemAt& at, const Ray& ray, Apertures apertures);

/// Converts a point [mm] from the coordinates of the lens to those of a surface: its vertex is the origin,
/// its axis z.
[[nodiscard]] Imath::V3d local_point(const SystemAt& at, std::size_t surface, const Imath::V3d& point);

/// Fraction of the power of unpolarised light transmitted along the path of the ray `start` through `trace`,
/// by surfaces (`UnpolarisedFields`) and by absorption in glass.
[[nodiscard]] double transmittance(const SystemAt& at, const Ray& start, const RayPath& path);

/// Reason for the end of a ray, as a clause such as "misses surface 3"; surfaces count from 1.
[[nodiscard]] std::string reason(const RayPath& path);

}  // namespace abbe::lens
