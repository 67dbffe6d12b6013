#pragma once

#include <optional>
#include <vector>

#include "lens/media_table.h"
#include "lens/trace.h"

namespace abbe::lens {

/// A ray in the plane of the image, or the lanes of one.
template <typename Real>
struct BasicArrival {
  Truth<Real> arrived;          ///< Nothing else is told of what does not get there.
  Imath::Vec2<Real> point;      ///< [mm]
  Imath::Vec3<Real> direction;  ///< Unit.
  Real transmittance;           ///< Of unpolarised light on its way there, by surfaces and glass.
};
using Arrival = BasicArrival<double>;

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

  /// Follows a ray of the object's side to the image, clear apertures obeyed; nothing if it does not get
  /// there.
  [[nodiscard]] std::optional<Arrival> to_image(const Ray& ray, double wavelength_nm) const;
  /// The same of all lanes of a packet, which come along the same ray.
  [[nodiscard]] BasicArrival<Doubles> to_image(const Ray& ray, const SampledSpectrum& wavelengths_nm) const;
  /// Follows a ray that comes from the image, towards -z, out to the object's side.
  [[nodiscard]] std::optional<Ray> to_object(const Ray& ray, double wavelength_nm) const;
  /// Where such a ray passes the stop, in radii of the stop from its middle, whatever clear apertures say;
  /// nothing if it does not get there.
  [[nodiscard]] std::optional<Imath::V2d> at_stop(const Ray& ray, double wavelength_nm) const;

 private:
  template <typename Real>
  [[nodiscard]] BasicArrival<Real> follow(BasicRay<Real> ray, const Real& wavelength_nm) const;
  [[nodiscard]] Crossing<double> cross_next(std::size_t surface, const MediaTable::Place<double>& place,
                                            const Ray& ray) const;

  System system_;
  double stop_radius_mm_;
  std::vector<SystemAt::Frame> frames_;
  std::vector<double> vertex_z_;
  MediaTable media_;
};

}  // namespace abbe::lens
