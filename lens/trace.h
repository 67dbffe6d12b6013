#pragma once

#include <limits>
#include <vector>

#include "lens/route.h"
#include "lens/system.h"

// Effect of a surface on one ray or several. Templates are instantiated for `double`, `Doubles` and `Floats`,
// and `UnpolarisedFields` for `double` and `Floats`.
namespace abbe::lens {

/// A surface at its position, with the refractive indices before it (object side) and behind it (image side),
/// whatever the direction of travel.
template <typename Real>
struct SurfaceBetween {
  const Surface& surface;
  const SystemAt::Frame& frame;
  Real n_before;
  Real n_behind;
};

/// Intersection of a ray with a surface, in the coordinates of the lens [mm].
template <typename Real>
struct BasicRayHit {
  Imath::Vec3<Real> point;      ///< On the surface.
  Imath::Vec3<Real> normal;     ///< Unit vector, towards +z.
  Imath::Vec3<Real> direction;  ///< Unit vector along which the ray leaves the surface.
  Real length_mm;  ///< Distance from the origin of the ray; negative for rays that travel towards -z.
};
using RayHit = BasicRayHit<double>;

/// Result of tracing a ray to a surface. `hit` is meaningless if the ray misses it or is totally reflected.
template <typename Real>
struct Crossing {
  BasicRayHit<Real> hit;
  Mask<Real> intersects;  ///< False if the ray misses the surface.
  Mask<Real> within;      ///< True if the hit is inside the clear aperture and its blades.
  Mask<Real> refracted;   ///< False for total reflection; true after `reflect`.
};

/// Refracts a ray that travels towards +z.
template <typename Real>
[[nodiscard]] Crossing<Real> cross(const SurfaceBetween<Real>& at, const BasicRay<Real>& ray);

/// Refracts a ray that travels towards -z. The direction in `hit` also points towards -z, into the space
/// before the surface. The length is negative.
template <typename Real>
[[nodiscard]] Crossing<Real> cross_back(const SurfaceBetween<Real>& at, const BasicRay<Real>& ray);

/// Reflects a ray. `forwards` is true if it arrives travelling towards +z; otherwise the length in `hit` is
/// negative.
template <typename Real>
[[nodiscard]] Crossing<Real> reflect(const SurfaceBetween<Real>& at, const BasicRay<Real>& ray,
                                     bool forwards);

/// Reflectance and transmittance of a surface with its coating, as fractions of the power of s and p. The
/// light travels towards +z (`forwards`) or -z. `cos_i` in [0, 1] is the cosine of its angle of incidence in
/// the medium from which it arrives.
[[nodiscard]] FresnelPower<double> surface_power(const SurfaceBetween<double>& at, double wavelength_nm,
                                                 double cos_i, bool forwards);
/// Computes each lane of two packets in double precision.
[[nodiscard]] FresnelPower<Floats> surface_power(const SurfaceBetween<Floats>& at,
                                                 const Floats& wavelengths_nm, const Floats& cos_i,
                                                 bool forwards);

/// Unpolarised light on its path through surfaces, as two orthogonal fields. Every surface attenuates their s
/// and p components by its own amplitudes. The phases of coatings and of total reflection are ignored, so s
/// and p keep their relative phase. Reflection at less than Brewster's angle reverses p relative to s.
template <typename Real>
class UnpolarisedFields {
 public:
  /// Light of power 1 that travels along a unit vector.
  explicit UnpolarisedFields(const Imath::Vec3<Real>& direction);
  /// Applies a surface to light that arrives along the unit vector `from`. `hit` is the result of `cross`, or
  /// of `reflect` if `how.reflects`. A surface without coating and change of index transmits all light.
  void apply(const SurfaceBetween<Real>& at, const Real& wavelength_nm, const Imath::Vec3<Real>& from,
             const BasicRayHit<Real>& hit, Encounter how);
  /// Remaining fraction of the power, in [0, 1].
  [[nodiscard]] Real power() const { return (first_.dot(first_) + second_.dot(second_)) * 0.5; }
  /// Fields that began as unit vectors along two axes, normal to the present direction of the light. Their
  /// lengths are amplitudes. The second axis is the cross product of the initial direction and the first.
  [[nodiscard]] const Imath::Vec3<Real>& first() const { return first_; }
  [[nodiscard]] const Imath::Vec3<Real>& second() const { return second_; }

 private:
  Imath::Vec3<Real> first_;
  Imath::Vec3<Real> second_;
};

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
/// passes the first `surfaces` surfaces, by default all, and continues to the image if these are all.
[[nodiscard]] RayPath trace(const SystemAt& at, const Ray& ray, Apertures apertures,
                            std::size_t surfaces = std::numeric_limits<std::size_t>::max());

/// Converts a point [mm] from the coordinates of the lens to those of a surface: its vertex is the origin,
/// its axis z.
[[nodiscard]] Imath::V3d local_point(const SystemAt& at, std::size_t surface, const Imath::V3d& point);

/// Fraction of the power of unpolarised light transmitted along the path of the ray `start` through `trace`,
/// by surfaces (`UnpolarisedFields`) and by absorption in glass.
[[nodiscard]] double transmittance(const SystemAt& at, const Ray& start, const RayPath& path);

/// Reason for the end of a ray, as a clause such as "misses surface 3"; surfaces count from 1.
[[nodiscard]] std::string reason(const RayPath& path);

}  // namespace abbe::lens
