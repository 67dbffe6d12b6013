#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/index.h"
#include "lens/system.h"

// Lens prescriptions, as their files say them: lengths in mm, angles in degrees.
namespace abbe::spec {

inline constexpr Range kModelIndex{1, 4, true, false};  ///< Of n_d.
inline constexpr Range kAbbeNumber{1, 1000};
using lens::kMaxMm;
inline constexpr Range kPositiveMm{0, kMaxMm, true, false, "mm"};
inline constexpr Range kFieldAngle = Range{-120, 120}.in("degrees");

/// A glass by its index at the d line and its Abbe number there.
struct ModelGlass {
  double nd = 1.5;
  double vd = 60;
};
struct LensGlass : schema::Located<std::variant<ModelGlass, Ior>> {};

struct LensSurface {
  double radius = 0;  ///< 0 for a plane.
  double thickness = 0;
  std::optional<LensGlass> glass;
  std::optional<double> aperture;  ///< Half its diameter.
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

/// The system. Reports a stop that is missing or doubled, unknown glasses, clear apertures beyond the edge of
/// their surface, surfaces that cross within theirs, and apertures, fields and wavelengths that do not fit;
/// nothing then. Warns of wavelengths that glasses have no data at. With `wavelengths_nm` it is looked at at
/// these, the middle one being the primary, its stop and image set at its own.
[[nodiscard]] std::optional<lens::System> build(const spec::Lens& lens, LoadContext& context,
                                                const std::vector<double>& wavelengths_nm = {});

}  // namespace abbe::description
