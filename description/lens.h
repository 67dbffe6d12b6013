#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/index.h"
#include "lens/system.h"

// Lens prescriptions in the units of their files: lengths in mm, angles in degrees.
namespace abbe::spec {

inline constexpr Range kModelIndex{1, 4, true, false};  ///< Range of n_d.
inline constexpr Range kAbbeNumber{1, 1000};
using lens::kMaxMm;
inline constexpr Range kPositiveMm{0, kMaxMm, true, false, "mm"};
inline constexpr Range kFieldAngle = Range{-120, 120}.in("degrees");

/// A glass given by its index n_d and its Abbe number V_d at the d line.
struct ModelGlass {
  double nd = 1.5;
  double vd = 60;
};
struct LensGlass : schema::Located<std::variant<ModelGlass, Ior>> {};

struct LensSurface {
  double radius = 0;     ///< Radius of curvature; 0 for a plane.
  double thickness = 0;  ///< Distance along the axis to the next surface.
  std::optional<LensGlass> glass;
  std::optional<double> aperture;  ///< Half the diameter of the clear aperture.
  bool stop = false;
  double conic = 0;
  double r2 = 0;
  std::vector<double> asphere;
  std::array<double, 2> decenter{0, 0};
  std::array<double, 2> tilt_deg{0, 0};
  std::vector<LayerEntry> coating;
  SourcePosition where;
};

struct PupilDiameter : schema::Value<double> {};
struct FNumber : schema::Value<double> {};
struct FieldAngles : schema::Value<std::vector<double>> {};
struct ObjectHeights : schema::Value<std::vector<double>> {};
struct ImageHeights : schema::Value<std::vector<double>> {};

enum class LensFocus { given, paraxial, best };

struct Lens {
  std::string title;
  std::string source;
  std::vector<LensSurface> surfaces;
  std::variant<std::monostate, PupilDiameter, FNumber> aperture;
  std::variant<std::monostate, FieldAngles, ObjectHeights, ImageHeights> fields;
  std::optional<double> object_distance;
  std::vector<double> wavelengths_nm{486.1327, 587.5618, 656.2725};
  std::optional<schema::Located<double>> primary_nm;
  LensFocus focus = LensFocus::given;
  double defocus = 0;
  SourcePosition where;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Lens>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the lens system. Returns nothing after an error:
/// - a stop that is missing, or a second stop;
/// - unknown glasses;
/// - clear apertures larger than their surface, and surfaces that cross within their clear apertures;
/// - apertures, fields and wavelengths that do not fit together.
/// Warns of wavelengths at which a glass has no data. `wavelengths_nm`, if given, replace the wavelengths of
/// the prescription, with the median one as the primary. Stop and image are still set at the prescription's
/// own primary wavelength.
[[nodiscard]] std::optional<lens::System> build(const spec::Lens& lens, LoadContext& context,
                                                const std::vector<double>& wavelengths_nm = {});

}  // namespace abbe::description
