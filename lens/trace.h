#pragma once

#include <vector>

#include "lens/crossing.h"

namespace abbe::lens {

/// How a ray ends.
enum class RayEnd {
  image,             ///< In the plane of the image.
  missed,            ///< It does not meet a surface.
  total_reflection,  ///< It cannot leave the glass.
  stopped            ///< Beyond the clear aperture of a surface.
};

/// Whether clear apertures stop light.
enum class Apertures { obeyed, ignored };

/// A ray's way, exact to double precision.
struct RayPath {
  RayEnd end = RayEnd::image;
  std::size_t at = 0;         ///< The surface it ended at; their number when it reached the image.
  std::vector<RayHit> hits;   ///< Surfaces passed.
  Ray last;                   ///< From where it was last, the image if it got there.
  double last_length_mm = 0;  ///< From the last surface to the image.

  [[nodiscard]] bool reached() const { return end == RayEnd::image; }
};

/// Follows a ray through `surfaces` surfaces in their order and, when these are all, to the image.
/// [Welford1986]
[[nodiscard]] RayPath trace(const SystemAt& at, const Ray& ray, Apertures apertures, std::size_t surfaces);
[[nodiscard]] RayPath trace(const SystemAt& at, const Ray& ray, Apertures apertures);

/// The point of a hit in the coordinates of its surface.
[[nodiscard]] Imath::V3d local_point(const SystemAt& at, std::size_t surface, const Imath::V3d& point);

/// Share of the power of unpolarised light that passes along a traced path: what `WeakenedLight` keeps, and
/// what absorption in glass leaves of it.
[[nodiscard]] double transmittance(const SystemAt& at, const Ray& start, const RayPath& path);

/// Why a ray ended, as a clause: "misses surface 3".
[[nodiscard]] std::string reason(const RayPath& path);

}  // namespace abbe::lens
