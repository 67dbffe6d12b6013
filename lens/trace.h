#pragma once

#include <vector>

#include "lens/system.h"

namespace abbe::lens {

/// How a ray ends.
enum class RayEnd {
  image,             ///< In the plane of the image.
  missed,            ///< It does not meet a surface.
  total_reflection,  ///< It cannot leave the glass.
  stopped            ///< Beyond the clear aperture of a surface.
};

/// Where a ray passes a surface.
struct RayHit {
  Imath::V3d point;      ///< On the surface.
  Imath::V3d normal;     ///< Unit, towards +z.
  Imath::V3d direction;  ///< Behind the surface.
  double length_mm;      ///< From the last surface, or from the ray's origin.
};

/// A surface where it stands, between the indices before and behind it.
struct SurfaceBetween {
  const Surface& surface;
  const SystemAt::Frame& frame;
  double n_before;
  double n_behind;
};

/// Whether clear apertures stop light.
enum class Apertures { obeyed, ignored };

/// Takes a ray through a surface, and tells of it in `hit` if it ends at RayEnd::image.
[[nodiscard]] RayEnd cross(const SurfaceBetween& at, Apertures apertures, const Ray& ray, RayHit& hit);

/// The same of a ray that goes the other way, towards -z; its direction in `hit` is that before the surface,
/// and the length is as negative as it is long.
[[nodiscard]] RayEnd cross_back(const SurfaceBetween& at, Apertures apertures, const Ray& ray, RayHit& hit);

/// Unpolarised light on its way through surfaces: two fields across each other, s and p of which every
/// surface weakens by its own amplitudes. Of coatings the phases are left out, so that beyond them s and p
/// keep the phase they had.
class WeakenedLight {
 public:
  explicit WeakenedLight(const Imath::V3d& direction);
  /// Passes a surface, coming along `from`.
  void cross(const SurfaceBetween& at, double wavelength_nm, const Imath::V3d& from, const RayHit& hit);
  /// Share of the power that is left.
  [[nodiscard]] double power() const { return (first_.length2() + second_.length2()) / 2; }

 private:
  Imath::V3d first_;
  Imath::V3d second_;
};

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
