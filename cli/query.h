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

/// Queries about data and closed forms. Each prints its answer, as JSON or as plain text, and returns 0.
/// Wavelengths are in standard air. `query ior` prints indices as catalogued. All answers about surfaces are
/// for a surface in air, as in scenes, with indices relative to air. Wavelengths must be inside the range of
/// the table. An unknown name or an invalid table throws InvalidInput with the code `input`, and the nearest
/// name. A wavelength outside the table of a material throws Error{usage}. So does one without a measured k,
/// if the answer depends on k.

/// Options of `query ior`, `query critical` and `query brewster`.
struct IndexOptions {
  std::string name;  ///< Material: a name, or a file (.csv, .yml).
  std::vector<double> at_nm;
  bool json = false;
  /// Thickness of the sample, used by `query ior` only; none by default.
  std::optional<double> thickness_mm = {};
  bool arrays = false;  ///< Print lists of wavelengths as lists even if they have one element.
};
/// Prints the index n + ik as catalogued, relative to the medium that it also prints. If a thickness d is
/// given, it also prints the internal transmittance exp(-4 pi k d/lambda). Both k and the transmittance are
/// null if k is not measured.
int query_ior(const IndexOptions& options);
/// Prints the critical angle of total reflection inside the material, against air. It is null for n <= 1 and
/// for 4 pi k >= 1, as in metals, where no wave propagates for a wavelength.
int query_critical(const IndexOptions& options);
/// Prints the angle of minimum R_p for light from outside, and R_p there. It is Brewster's angle atan(n) with
/// R_p = 0, or the pseudo-Brewster angle of an absorbing material.
int query_brewster(const IndexOptions& options);

/// Options of `query reflectance`: a polished surface, optionally under thin films, for light from air. The
/// phases of the reflected fields follow exp(-i omega t); the sign of the field in the plane of incidence is
/// that of `FilmReflection`.
struct ReflectanceOptions {
  std::string name;
  std::vector<double> at_nm;
  std::vector<double> angles_deg{0};  ///< Angles of incidence in air, 0 to 90.
  bool json = false;
  std::string coating = {};  ///< Thin films from outside inwards, as "MATERIAL:NM,MATERIAL:NM".
  /// Print lists of wavelengths and of angles as lists even if they have one element.
  bool arrays = false;
};
/// Prints Rs, Rp, their mean R and the phases of both reflected fields [degrees, 0 to 360] for each
/// wavelength and angle. If there is a coating, it also prints the transmittance T. Throws Error{usage} for
/// an invalid coating.
int query_reflectance(const ReflectanceOptions& options);

/// Options of `query prism`: minimum deviation in air, or the deviation at one incidence.
struct PrismOptions {
  std::string name;
  double apex_deg = 60;  ///< Angle between the two faces, in (0, 180).
  std::vector<double> at_nm;
  /// Angle of incidence at the first face, in (-90, 90); minimum deviation without a value.
  std::optional<double> incidence_deg;
  bool json = false;
  bool arrays = false;  ///< Print lists of wavelengths as lists even if they have one element.
};
/// Prints deviation, incidence and transmittances. They are null if no ray passes, and for a material that
/// absorbs too much to be a glass.
int query_prism(const PrismOptions& options);

/// Integration of colours: in steps of 1 nm, or by the weights of ASTM E308 at the measured wavelengths.
enum class ColorMethod { one_nm, astm_e308 };

/// Options of `query color`: a reflectance, or the perfect diffuser without a name.
struct ColorOptions {
  std::string illuminant;  ///< A name, a file, or a formula such as "blackbody:2856" [K].
  Observer observer = Observer::cie1931;
  std::string reflectance = {};  ///< A name, or a file with its column; empty for the perfect diffuser.
  bool json = false;
  ColorMethod method = ColorMethod::one_nm;
  std::optional<SumRange> range = {};  ///< Range of `ColorMethod::one_nm`; ASTM E308 has its own.
};
/// Prints X, Y, Z (Y = 100 for the perfect diffuser), x, y and L*, a*, b* relative to that diffuser. Throws
/// Error{usage} for a range with `ColorMethod::astm_e308`, Error{input} for an illuminant without visible
/// light.
int query_color(const ColorOptions& options);

/// Options of `query delta-e`: two colours L*, a*, b*; the first is the standard.
struct DeltaEOptions {
  std::array<double, 3> lab1{};
  std::array<double, 3> lab2{};
  bool json = false;
};
/// Prints the differences by CIEDE2000, CIE 1976 and CIE 1994. It also prints CAM16-UCS and ITP, which take
/// both colours as relative to a D65 white, ITP with a white of 203 cd/m^2.
int query_delta_e(const DeltaEOptions& options);

/// Options of `query light`: an illuminant or pixels of a spectral image, optionally through filters and
/// after reflection.
struct LightOptions {
  std::string name;                 ///< An illuminant or a spectral EXR.
  std::string filters = {};         ///< Files or names in `data/filter`, separated by commas.
  std::string reflectance = {};     ///< Surface that reflects the light; empty for none.
  std::optional<Crop> crop = {};    ///< Pixels of an image; all without a crop.
  std::filesystem::path plot = {};  ///< SVG of the colour vector graphic; empty for none.
  bool samples = false;             ///< Also print the fidelity of each of the 99 samples.
  SumRange range = {};              ///< Range of all sums but that of the luminous efficacy.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};
/// Prints chromaticity, colour temperature, luminous efficacy of radiation [lm/W], scotopic ratio, colour
/// rendering and fidelity. The colour temperature and what depends on it are null if there is none. Throws
/// Error{input} for a light without visible light, and for a plot without a colour temperature up to 25 000
/// K. Throws Error{usage} for a crop of a light that is not an image.
int query_light(const LightOptions& options);

/// Options of `query metamerism`: two reflectances that match under one illuminant, compared under another.
struct MetamerismOptions {
  std::string first;
  std::string second;
  std::string reference = "D65";  ///< Illuminant under which the reflectances match.
  std::string test = "A";         ///< Illuminant under which they are compared.
  bool json = false;
  SumRange range = {};
};
/// Prints the figures of `Metamerism`, and throws its Error{input}.
int query_metamerism(const MetamerismOptions& options);

/// Options of `query camera`: raw values of a reflectance, or of the perfect diffuser without a name; or
/// metrics of the camera's colour accuracy.
struct CameraOptions {
  std::string name;         ///< Camera: a name in `data/camera` or a file.
  std::string illuminant;   ///< Illuminant of the raw values; empty for metrics.
  std::string reflectance;  ///< Reflectance of the raw values; empty for the perfect diffuser.
  /// Print the Vora value, the residuals of x, y, z and the sensitivity index instead of raw values.
  bool metrics = false;
  bool json = false;
  /// Quantity that the spectral responses multiply; by default the choice of `load_camera`.
  std::optional<ResponseKind> response = {};
};
/// Prints raw values, which are 1 for the perfect diffuser in the channel G, or the metrics. Throws
/// Error{usage} if the illuminant is missing, unless the metrics are requested, and for metrics of fewer than
/// three channels.
int query_camera(const CameraOptions& options);

/// Options of `query --list [KIND]`: the names of every kind, or of one. A list of materials or glasses also
/// has their wavelength ranges and sources.
struct ListOptions {
  std::string kind;  ///< One of `table_kinds`; empty for every kind.
  bool json = false;
};
/// Prints the names. Throws Error{usage} for an unknown kind.
int query_list(const ListOptions& options);
/// The kinds that `query --list` knows, in the order in which it prints them.
[[nodiscard]] std::vector<std::string> table_kinds();

}  // namespace abbe::cli
