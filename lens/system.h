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

// Lens systems: surfaces in the order in which light meets them, which goes towards +z. The first vertex is
// the origin, lengths are millimetres, angles degrees, indices relative to air, in which the lens stands.
namespace abbe::lens {

/// The greatest of lengths [mm]: what rays near the axis would meet further away is at infinity, as where
/// the digits of a prescription alone keep them from being parallel.
inline constexpr double kMaxMm = 1e9;

inline constexpr double kMmPerM = 1000;

/// What lies behind a surface.
struct Glass {
  std::string name;
  RefractiveIndex index;
};

/// A surface with what follows it.
struct Surface {
  Profile profile;
  double thickness_mm = 0;                 ///< Along the axis, to the next vertex or the image.
  std::optional<Glass> behind;             ///< Air if none.
  std::optional<double> semi_aperture_mm;  ///< Light further from its axis is stopped.
  Imath::V2d decenter_mm{0, 0};            ///< Of its vertex alone; what follows stays where it is.
  Imath::V2d tilt_deg{0, 0};               ///< About x, then about the tilted y, through its vertex.
  Coating coating{};                       ///< From the air inwards.
  std::optional<Iris> iris{};              ///< Blades that leave a polygon of the semi-aperture's circle.

  [[nodiscard]] bool displaced() const;
};

/// How the size of the stop is told.
enum class ApertureKind {
  entrance_pupil,  ///< Diameter [mm] of the axial beam at the entrance pupil, at the primary wavelength.
  f_number,        ///< Focal length over that diameter.
  stop             ///< Semi-aperture of the stop itself [mm].
};
struct Aperture {
  ApertureKind kind = ApertureKind::stop;
  double value = 1;
};

/// A lens with the conditions under which it is looked at.
struct System {
  std::string title;
  std::string source;
  std::vector<Surface> surfaces;
  std::size_t stop = 0;  ///< The surface that limits the beam.
  Aperture aperture;
  std::optional<double> object_distance_mm;  ///< In front of the first vertex; at infinity if none.
  /// Directions of objects at infinity [degrees], heights of near ones [mm]: a positive direction is that of
  /// light that rises towards +y, a positive height is towards +y.
  std::vector<double> fields{0};
  double defocus_mm = 0;  ///< How far the image has been moved from its focus.
  std::vector<double> wavelengths_nm{587.5618};
  std::size_t primary = 0;            ///< Which of them the stop is set and the focus is found at,
  std::optional<double> set_at_nm{};  ///< if not at one of their own, in whose place they are.

  [[nodiscard]] double primary_nm() const { return wavelengths_nm[primary]; }
  /// Where a vertex is on the axis; that of the image for the number of surfaces.
  [[nodiscard]] double vertex_z(std::size_t surface) const;
  [[nodiscard]] bool displaced() const;  ///< Whether any surface is decentred or tilted.
};

/// The system with its stop open to the whole circle, without blades.
[[nodiscard]] System with_round_stop(System system);

/// A system at one wavelength.
struct SystemAt {
  SystemAt(const System& of, double wavelength);

  const System* system;
  double wavelength_nm;
  std::vector<double> n;                  ///< Before the first surface, then behind each.
  std::vector<double> absorption_per_mm;  ///< Of power, in the same places.
  std::vector<double> vertex_z;           ///< Of each surface, then of the image.
  struct Frame {
    Imath::V3d vertex;
    Imath::M33d to_world;  ///< For row vectors.
    Imath::M33d to_local;
    bool tilted;  ///< Both are more than the identity.
  };
  std::vector<Frame> frames;

  [[nodiscard]] std::size_t size() const { return system->surfaces.size(); }
  [[nodiscard]] const Surface& surface(std::size_t i) const { return system->surfaces[i]; }
};

}  // namespace abbe::lens
