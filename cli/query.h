#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/inputs.h"
#include "sensor/film/crop.h"
#include "sensor/response/channel.h"
#include "spectral/colorimetry.h"

namespace abbe::cli {

/// Queries about data and closed forms. Each prints its answer, as JSON or as plain text.
/// Wavelengths are in standard air. `query ior` prints indices as catalogued. All answers about surfaces are
/// for a surface in air, as in scenes, with indices relative to air. An unknown name or an invalid table
/// throws InvalidInput with the code `input`, and the nearest name. A wavelength outside the table of a
/// material throws Error{usage}. So does one without a measured k, if the answer depends on k. The help of an
/// option explains the members; texts that are empty and values that are absent were not given.

/// Options of `query ior`, `query critical` and `query brewster`.
struct IndexOptions {
  std::string name;
  std::vector<double> at_nm;
  bool json = false;
  std::optional<double> thickness_mm = {};  ///< Used by `query ior` only.
  bool arrays = false;
};
/// Prints n + ik as catalogued, the medium to which it is relative, and for a thickness d the internal
/// transmittance exp(-4 pi k d/lambda). k and the transmittance are null if k is not measured.
void query_ior(const IndexOptions& options);
/// Prints the critical angle of total reflection inside the material, against air. It is null for n <= 1 and
/// for 4 pi k >= 1, as in metals, where no wave propagates for a wavelength.
void query_critical(const IndexOptions& options);
/// Prints the angle of minimum R_p for light from outside, and R_p there. It is Brewster's angle atan(n) with
/// R_p = 0, or the pseudo-Brewster angle of an absorbing material.
void query_brewster(const IndexOptions& options);

/// Options of `query reflectance`: a polished surface, optionally under thin films, for light from air. The
/// phases of the reflected fields follow exp(-i omega t); the sign of the field in the plane of incidence is
/// that of `FilmReflection`.
struct ReflectanceOptions {
  std::string name;
  std::vector<double> at_nm;
  std::vector<double> angles_deg{0};  ///< Angles of incidence in air, 0 to 90.
  bool json = false;
  std::string coating = {};
  bool arrays = false;
};
/// Prints Rs, Rp, their mean R and the phases of both reflected fields [degrees, 0 to 360] for each
/// wavelength and angle, and under a coating the transmittance T. The phases follow exp(-i omega t); the sign
/// of the field in the plane of incidence is that of `FresnelAmplitudes`. Throws Error{usage} for an invalid
/// coating.
void query_reflectance(const ReflectanceOptions& options);

struct PrismOptions {
  std::string name;
  double apex_deg = 60;  ///< Angle between the two faces, in (0, 180).
  std::vector<double> at_nm;
  std::optional<double>
      incidence_deg;  ///< At the first face, in (-90, 90); minimum deviation without a value.
  bool json = false;
  bool arrays = false;
};
/// Prints deviation, incidence and transmittances. They are null if no ray passes, and for a material that
/// absorbs too much to be a glass.
void query_prism(const PrismOptions& options);

/// Integration of colours: in steps of 1 nm, or by the weights of ASTM E308 at the measured wavelengths.
enum class ColorMethod { one_nm, astm_e308 };

struct ColorOptions {
  std::string illuminant;
  Observer observer = Observer::cie1931;
  std::string reflectance = {};
  bool json = false;
  ColorMethod method = ColorMethod::one_nm;
  std::optional<SumRange> range = {};  ///< Range of `ColorMethod::one_nm`; ASTM E308 has its own.
};
/// Prints X, Y, Z (Y = 100 for the perfect diffuser), x, y and L*, a*, b* relative to that diffuser. Throws
/// Error{usage} for a range with `ColorMethod::astm_e308`, Error{input} for an illuminant without visible
/// light.
void query_color(const ColorOptions& options);

struct DeltaEOptions {
  std::array<double, 3> lab1{};  ///< L*, a*, b* of the standard.
  std::array<double, 3> lab2{};
  bool json = false;
};
/// Prints the differences by CIEDE2000, CIE 1976 and CIE 1994. It also prints CAM16-UCS and ITP, which take
/// both colours as relative to a D65 white, ITP with a white of 203 cd/m^2.
void query_delta_e(const DeltaEOptions& options);

struct LightOptions {
  std::string name;
  std::string filters = {};
  std::string reflectance = {};
  std::optional<Crop> crop = {};
  std::filesystem::path plot = {};
  bool samples = false;
  SumRange range = {};  ///< Range of all sums but that of the luminous efficacy.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};
/// Prints chromaticity, colour temperature, luminous efficacy of radiation [lm/W], scotopic ratio, colour
/// rendering and fidelity. The colour temperature and what depends on it are null if there is none. Throws
/// Error{input} for a light without visible light, and for a plot without a colour temperature up to 25 000
/// K. Throws Error{usage} for a crop of a light that is not an image.
void query_light(const LightOptions& options);

struct MetamerismOptions {
  std::string first;
  std::string second;
  std::string reference = "D65";
  std::string test = "A";
  bool json = false;
  SumRange range = {};
};
/// Prints the figures of `Metamerism`, and throws its Error{input}.
void query_metamerism(const MetamerismOptions& options);

struct CameraOptions {
  std::string name;
  std::string illuminant;
  std::string reflectance;
  bool metrics = false;
  bool json = false;
  std::optional<ResponseKind> response = {};
};
/// Prints raw values, which are 1 for the perfect diffuser in the channel G, or the metrics. Throws
/// Error{usage} if the illuminant is missing, unless the metrics are requested, and for metrics of fewer than
/// three channels.
void query_camera(const CameraOptions& options);

struct ListOptions {
  std::string kind;  ///< One of `table_kinds`; empty for every kind.
  bool json = false;
};
/// Prints the names of every kind, or of one. A list of materials or glasses also has their wavelength ranges
/// and sources. Throws Error{usage} for an unknown kind.
void query_list(const ListOptions& options);
/// The kinds that `query --list` knows, in the order in which it prints them.
[[nodiscard]] std::vector<std::string> table_kinds();

}  // namespace abbe::cli
