#pragma once

#include <optional>
#include <vector>

#include "lens/trace.h"
#include "spectral/curve.h"

namespace abbe::lens {

/// A ray in the plane of the image.
struct Arrival {
  Imath::V2d point;      ///< [mm]
  Imath::V3d direction;  ///< Unit.
  double transmittance;  ///< Of unpolarised light on its way there, by surfaces and glass.
};

/// A system to be traced at any wavelength, many times: what it is at one is looked up in tables of indices
/// every nanometre, to 1e-7 or so, and nothing is allocated.
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
  /// Follows a ray that comes from the image, towards -z, out to the object's side.
  [[nodiscard]] std::optional<Ray> to_object(const Ray& ray, double wavelength_nm) const;
  /// Where such a ray passes the stop, in radii of the stop from its middle, whatever clear apertures say;
  /// nothing if it does not get there.
  [[nodiscard]] std::optional<Imath::V2d> at_stop(const Ray& ray, double wavelength_nm) const;

 private:
  [[nodiscard]] double n(std::size_t medium, double wavelength_nm) const {
    return medium == 0 || !system_.surfaces[medium - 1].behind ? 1 : n_[medium](wavelength_nm);
  }
  [[nodiscard]] RayEnd back_through(std::size_t surface, Apertures apertures, double wavelength_nm, Ray& ray,
                                    double& n_behind, RayHit& hit) const;

  System system_;
  double stop_radius_mm_;
  std::vector<SystemAt::Frame> frames_;
  std::vector<double> vertex_z_;
  std::vector<Curve> n_;           // before the first surface, then behind each
  std::vector<Curve> absorption_;  // of power, in the same places [1/mm]
};

}  // namespace abbe::lens
