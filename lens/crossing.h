#pragma once

#include "lens/route.h"
#include "lens/system.h"

// What a surface does to a ray, for one ray or for several: templates are there for `double`, `Doubles` and
// `Floats`, of light for `double` and `Floats`.
namespace abbe::lens {

/// A surface where it stands, between the indices before and behind it.
template <typename Real>
struct SurfaceBetween {
  const Surface& surface;
  const SystemAt::Frame& frame;
  Real n_before;
  Real n_behind;
};

/// Where a ray passes a surface.
template <typename Real>
struct BasicRayHit {
  Imath::Vec3<Real> point;      ///< On the surface.
  Imath::Vec3<Real> normal;     ///< Unit, towards +z.
  Imath::Vec3<Real> direction;  ///< Behind the surface.
  Real length_mm;               ///< From the last surface, or from the ray's origin.
};
using RayHit = BasicRayHit<double>;

/// A ray at a surface. Where it does not meet it or is totally reflected, `hit` says nothing of use.
template <typename Real>
struct Crossing {
  BasicRayHit<Real> hit;
  Truth<Real> met;
  Truth<Real> within;     ///< The clear aperture.
  Truth<Real> refracted;  ///< Not totally reflected.
};

/// Takes a ray through a surface.
template <typename Real>
[[nodiscard]] Crossing<Real> cross(const SurfaceBetween<Real>& at, const BasicRay<Real>& ray);

/// The same of a ray that goes the other way, towards -z; its direction in `hit` is that before the surface,
/// and the length is as negative as it is long.
template <typename Real>
[[nodiscard]] Crossing<Real> cross_back(const SurfaceBetween<Real>& at, const BasicRay<Real>& ray);

/// The same of a ray that the surface reflects, on its way towards +z if it goes `forwards`, else towards -z.
template <typename Real>
[[nodiscard]] Crossing<Real> reflect(const SurfaceBetween<Real>& at, const BasicRay<Real>& ray,
                                     bool forwards);

/// What the surface, with its coating, reflects and lets through of light that comes to it on its way towards
/// +z, or, if not `forwards`, towards -z.
[[nodiscard]] FresnelPower<double> surface_power(const SurfaceBetween<double>& at, double wavelength_nm,
                                                 double cos_i, bool forwards);
/// The same of the lanes of a packet.
[[nodiscard]] FresnelPower<Floats> surface_power(const SurfaceBetween<Floats>& at,
                                                 const Floats& wavelengths_nm, const Floats& cos_i,
                                                 bool forwards);

/// Unpolarised light on its way through surfaces: two fields across each other, s and p of which every
/// surface weakens by its own amplitudes. Of coatings and of total reflection the phases are left out, so
/// that beyond them s and p keep the phase they had; but reflected p is turned against s below Brewster's
/// angle.
template <typename Real>
class WeakenedLight {
 public:
  explicit WeakenedLight(const Imath::Vec3<Real>& direction);
  /// Meets a surface, coming along `from`.
  void meet(const SurfaceBetween<Real>& at, const Real& wavelength_nm, const Imath::Vec3<Real>& from,
            const BasicRayHit<Real>& hit, Encounter how);
  /// Share of the power that is left.
  [[nodiscard]] Real power() const { return (first_.dot(first_) + second_.dot(second_)) * 0.5; }
  /// What has become of a unit field along the first axis, and of one along the second, which is the
  /// direction at the start x the first.
  [[nodiscard]] const Imath::Vec3<Real>& first() const { return first_; }
  [[nodiscard]] const Imath::Vec3<Real>& second() const { return second_; }

 private:
  Imath::Vec3<Real> first_;
  Imath::Vec3<Real> second_;
};

}  // namespace abbe::lens
