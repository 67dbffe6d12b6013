#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "lens/media_table.h"
#include "lens/route.h"
#include "lens/trace.h"

namespace abbe::lens {

/// A ray in the plane of the image, or the lanes of one.
template <typename Real>
struct BasicArrival {
  Truth<Real> arrived;          ///< Nothing else is told of what does not get there.
  Imath::Vec2<Real> point;      ///< [mm]
  Imath::Vec3<Real> direction;  ///< Unit.
  Real transmittance;           ///< Of unpolarised light on its way there, by surfaces and glass.
  Imath::Vec3<Real> last;       ///< The point of the last surface that it comes from.
  Imath::Vec3<Real> first;      ///< What surfaces leave of the fields that `WeakenedLight` starts with.
  Imath::Vec3<Real> second;
};
using Arrival = BasicArrival<double>;

/// A ray of the object's side that has come from the image, or the lanes of some.
template <typename Real>
struct BasicDeparture {
  Truth<Real> left;    ///< Nothing else is told of what does not get there.
  BasicRay<Real> ray;  ///< From the first surface.
};

/// A ray that light of one wavelength goes along.
struct ColouredRay {
  Ray ray;
  double wavelength_nm;
};

/// A ray along which all lanes of a packet go.
struct PacketRay {
  Ray ray;
  SampledSpectrum wavelengths_nm;
};

/// A point of a surface, and its unit normal towards +z.
struct SurfacePoint {
  Imath::V3d point;
  Imath::V3d normal;
  double cos_axis;  ///< Of the angle between the normal and the surface's own axis.
};

/// A system to be traced at any wavelength, many times: what it is at one is looked up in a `MediaTable`,
/// and nothing is allocated.
class SpectralSystem {
 public:
  /// Its stop, of this radius [mm], is an aperture like the others.
  SpectralSystem(System system, double stop_radius_mm);

  [[nodiscard]] const System& system() const { return system_; }
  [[nodiscard]] double stop_radius_mm() const { return stop_radius_mm_; }
  /// Where the last vertex is, and the plane of the image [mm].
  [[nodiscard]] double last_z() const { return vertex_z_[vertex_z_.size() - 2]; }
  [[nodiscard]] double image_z() const { return vertex_z_.back(); }

  /// The way by which light makes the image.
  [[nodiscard]] const Route& direct() const { return direct_; }
  /// Follows a ray of the object's side to the image, clear apertures obeyed; nothing if it does not get
  /// there.
  [[nodiscard]] std::optional<Arrival> to_image(const Ray& ray, double wavelength_nm,
                                                const Route& route) const;
  [[nodiscard]] std::optional<Arrival> to_image(const Ray& ray, double wavelength_nm) const {
    return to_image(ray, wavelength_nm, direct_);
  }
  /// The same of all lanes of two packets, those of each along one ray, in floats as rays of scenes are: by
  /// way of the image they end within 5e-5 mm of where they should.
  [[nodiscard]] BasicArrival<Floats> to_image(const std::array<PacketRay, 2>& rays, const Route& route) const;
  /// Follows a ray that comes from the image, towards -z, out to the object's side, the route backwards.
  [[nodiscard]] std::optional<Ray> to_object(const Ray& ray, double wavelength_nm, const Route& route) const;
  [[nodiscard]] std::optional<Ray> to_object(const Ray& ray, double wavelength_nm) const {
    return to_object(ray, wavelength_nm, direct_);
  }
  /// The same, by the direct way, of many rays, several at once, in their order.
  [[nodiscard]] std::vector<std::optional<Ray>> to_object(std::span<const ColouredRay> rays) const;
  /// Where such a ray passes the stop, in radii of the stop from its middle, whatever clear apertures say;
  /// nothing if it does not get there.
  [[nodiscard]] std::optional<Imath::V2d> at_stop(const Ray& ray, double wavelength_nm) const;

  /// The point of a surface that lies at (x, y) in the surface's own coordinates, no further from its axis
  /// than its edge, and the reverse.
  [[nodiscard]] SurfacePoint point_of(std::size_t surface, const Imath::V2d& local) const;
  [[nodiscard]] Imath::V2d local_of(std::size_t surface, const Imath::V3d& point) const;

 private:
  template <typename Real>
  [[nodiscard]] BasicArrival<Real> follow(BasicRay<Real> ray, const Real& wavelength_nm,
                                          const Route& route) const;
  template <typename Real>
  [[nodiscard]] BasicDeparture<Real> leave(BasicRay<Real> ray, const Real& wavelength_nm,
                                           const Route& route) const;
  template <typename Real>
  [[nodiscard]] Crossing<Real> meet_next(const Step& step, const MediaTable::Place<Real>& place,
                                         const BasicRay<Real>& ray) const;

  System system_;
  double stop_radius_mm_;
  std::vector<SystemAt::Frame> frames_;
  std::vector<double> vertex_z_;
  MediaTable media_;
  Route direct_;
};

}  // namespace abbe::lens
