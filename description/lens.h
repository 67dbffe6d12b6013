#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/index.h"
#include "lens/system.h"

// Lens prescriptions in the units of their files: lengths in mm, angles in degrees, wavelengths in nm.
// Refractive indices are relative to air. Light travels along +z.
namespace abbe::spec {

inline constexpr Range kModelIndex{1, 4, true, false};  ///< Allowed n_d: (1, 4].
inline constexpr Range kAbbeNumber{1, 1000};            ///< Allowed V_d.
using lens::kMaxMm;
inline constexpr Range kPositiveMm{0, kMaxMm, true, false, "mm"};  ///< Allowed lengths above 0: (0, kMaxMm].
inline constexpr Range kFieldAngle = Range{-120, 120}.in("degrees");

/// A glass n = A + B/lambda^2 with the index n_d at 587.5618 nm and the Abbe number V_d = (n_d - 1)/(n_F -
/// n_C).
struct ModelGlass {
  double nd = 1.5;
  double vd = 60;
};
struct LensGlass : schema::Located<std::variant<ModelGlass, Ior>> {};

/// A surface of a lens and the space behind it.
struct LensSurface {
  double radius = 0;  ///< Radius of curvature, positive if the center is behind the surface; 0 for a plane.
  double thickness = 0;            ///< Distance along the axis to the next surface, or to the image.
  std::optional<LensGlass> glass;  ///< Glass behind the surface; air if absent.
  std::optional<double> aperture;  ///< Half the diameter of the clear aperture; unlimited if absent.
  bool stop = false;               ///< True for the aperture stop, of which a lens has one.
  double conic = 0;                ///< Conic constant: 0 for a sphere, -1 for a paraboloid.
  double r2 = 0;                   ///< Coefficient of r^2 in the sag [1/mm].
  std::vector<double> asphere;     ///< Coefficients of r^4, r^6, ... r^20 in the sag [mm^-3, mm^-5, ...].
  std::array<double, 2> decenter{0, 0};  ///< Displacement along x and y; later surfaces do not move.
  std::array<double, 2> tilt_deg{0, 0};  ///< Tilt about x, then about the tilted y, of this surface alone.
  std::vector<LayerEntry> coating;       ///< Thin films, from the air inwards.
  SourcePosition where;
};

struct PupilDiameter : schema::Value<double> {};  ///< Diameter of the axial beam in the entrance pupil.
struct FNumber : schema::Value<double> {};        ///< Focal length over the diameter of the entrance pupil.
/// Angles to the axis. Light from a positive angle rises towards +y.
struct FieldAngles : schema::Value<std::vector<double>> {};
struct ObjectHeights : schema::Value<std::vector<double>> {};  ///< Heights of an object at a finite distance.
struct ImageHeights : schema::Value<std::vector<double>> {};   ///< Paraxial image heights.

/// Position of the image, before `Lens::defocus` is added.
enum class LensFocus {
  given,     ///< At the thickness of the last surface.
  paraxial,  ///< At the paraxial focus.
  best       ///< At the position where the spots of all fields and wavelengths are smallest.
};

/// A lens prescription.
struct Lens {
  std::string title;
  std::string source;                 ///< Source of the data.
  std::vector<LensSurface> surfaces;  ///< Order in which light passes them; at least one.
  std::variant<std::monostate, PupilDiameter, FNumber> aperture;  ///< By default the stop limits the beam.
  /// Fields along y; by default the axis alone.
  std::variant<std::monostate, FieldAngles, ObjectHeights, ImageHeights> fields;
  std::optional<double> object_distance;  ///< To the first surface; infinite if absent.
  std::vector<double> wavelengths_nm{486.1327, 587.5618, 656.2725};  ///< At least one.
  /// The one of `wavelengths_nm` at which stop and focus are set; by default element number size/2.
  std::optional<schema::Located<double>> primary_nm;
  LensFocus focus = LensFocus::given;
  double defocus = 0;  ///< Displacement of the image away from the lens.
  SourcePosition where;
};
/// Key table by which scene files are read, written and documented.
[[nodiscard]] schema::Fields fields(schema::Tag<Lens>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the lens system, in mm. Reports errors to `context.diagnostics` and returns nothing if they have
/// any:
/// - other than one stop, unknown glasses, and glass in front of the image;
/// - clear apertures larger than their surface, and surfaces that cross within their clear apertures;
/// - a stop that cannot open to the aperture, and an aperture to whose rim no ray can be traced;
/// - fields that the kind of object or an infinite pupil excludes, and the focus of an afocal lens;
/// - a primary wavelength that is not one of the wavelengths.
/// Warns of wavelengths at which a glass has no data, and of an axial beam that is partly cut off.
/// `wavelengths_nm`, unless empty, replace the wavelengths of the prescription, with the element number
/// size/2 as the primary. Stop and image are still set at the prescription's own primary wavelength.
[[nodiscard]] std::optional<lens::System> build(const spec::Lens& lens, LoadContext& context,
                                                const std::vector<double>& wavelengths_nm = {});

}  // namespace abbe::description
