#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <ImathMatrix.h>
#include <ImathVec.h>

#include "lens/iris.h"
#include "lens/profile.h"
#include "materials/index/refractive_index.h"
#include "materials/interface/coating.h"

// Lens systems: surfaces in the order in which light from the object, which travels towards +z, arrives at
// them. The first vertex is the origin and z the axis. Lengths are in millimetres, angles in degrees, indices
// relative to the surrounding air.
namespace abbe::lens {

/// Largest length [mm]. Paraxial intersections farther away count as at infinity; only the limited digits of
/// a prescription keep such rays from being parallel.
inline constexpr double kMaxMm = 1e9;

inline constexpr double kMmPerM = 1000;

/// Medium behind a surface.
struct Glass {
  std::string name;
  RefractiveIndex index;  ///< Index relative to air, and absorption.
};

/// A surface, and the space behind it.
struct Surface {
  Profile profile;
  double thickness_mm = 0;                 ///< Distance along the axis to the next vertex or the image.
  std::optional<Glass> behind;             ///< Air if absent.
  std::optional<double> semi_aperture_mm;  ///< Clear semi-aperture; blocks light farther from the axis.
  Imath::V2d decenter_mm{0, 0};            ///< Moves only this vertex, not the surfaces behind it.
  Imath::V2d tilt_deg{0, 0};   ///< Right-handed, about x, then about the tilted y, through the vertex.
  Coating coating{};           ///< Layers from the air inwards; between two glasses, from the front one.
  std::optional<Iris> iris{};  ///< Blades that restrict the semi-aperture to a polygon.

  /// True if the surface is decentered or tilted.
  [[nodiscard]] bool displaced() const;
};

/// Quantity that defines the size of the stop.
enum class ApertureKind {
  entrance_pupil,  ///< Diameter [mm] of the axial beam at the entrance pupil, at the primary wavelength.
  f_number,        ///< |Focal length| over that diameter.
  stop             ///< Semi-aperture of the stop itself [mm].
};
/// Size of the stop, by one of these quantities; `value` > 0.
struct Aperture {
  ApertureKind kind = ApertureKind::stop;
  double value = 1;
};

/// A lens, and the conditions of its analysis. It has at least one surface, field and wavelength; functions
/// of this module do not check that.
struct System {
  std::string title;
  std::string source;
  std::vector<Surface> surfaces;
  std::size_t stop = 0;  ///< Index of the surface that limits the beam.
  Aperture aperture;
  std::optional<double> object_distance_mm;  ///< Distance before the first vertex, > 0; infinite if absent.
  /// Directions of objects at infinity [degrees], or heights of near objects [mm]. Light from a positive
  /// direction rises towards +y; a positive height is towards +y.
  std::vector<double> fields{0};
  /// Displacement of the image from its focus towards +z; included in the last thickness.
  double defocus_mm = 0;
  std::vector<double> wavelengths_nm{587.5618};
  std::size_t primary = 0;  ///< Index of the primary wavelength.
  /// Wavelength [nm] at which stop and focus were set, if the analysis replaced the wavelengths of the lens.
  /// If absent, it is the primary one.
  std::optional<double> set_at_nm{};

  [[nodiscard]] double primary_nm() const { return wavelengths_nm[primary]; }
  [[nodiscard]] bool displaced() const;  ///< True if any surface is.
};

/// The system without blades, so that its stop is round.
[[nodiscard]] System with_round_stop(System system);

/// A system at one wavelength [nm]. The system must outlive it.
struct SystemAt {
  SystemAt(const System& of, double wavelength);

  const System* system;
  double wavelength_nm;
  std::vector<double> n;                  ///< Indices before the first surface (1), then behind each.
  std::vector<double> absorption_per_mm;  ///< Coefficients a of e^(-a d) for power in the same media.
  std::vector<double> vertex_z;           ///< Positions z of each vertex, then of the image.
  struct Frame {
    Imath::V3d vertex;     ///< Position of the vertex, with its decentering.
    Imath::M33d to_world;  ///< Rotation of row vectors from the axes of the surface to those of the lens.
    Imath::M33d to_local;  ///< Inverse of `to_world`.
    bool tilted;           ///< False if both matrices are the identity.
  };
  std::vector<Frame> frames;  ///< Coordinates of each surface.

  [[nodiscard]] std::size_t size() const { return system->surfaces.size(); }
  [[nodiscard]] const Surface& surface(std::size_t i) const { return system->surfaces[i]; }
};

}  // namespace abbe::lens
