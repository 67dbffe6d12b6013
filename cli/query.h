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

/// Questions about data and closed forms. `query ior` prints indices as catalogued; all answers about
/// surfaces are for a surface in air, as in scenes, by indices relative to air. Wavelengths are those the
/// table covers; a name that is not found throws Error{input} with the nearest one, a wavelength outside the
/// table Error{usage}, as does one at which k is not measured where an answer hangs on it. Each prints its
/// answer and returns the exit code.

/// `query ior`, `query critical`, `query brewster`.
struct IndexOptions {
  std::string name;
  std::vector<double> at_nm;
  bool json = false;
  std::optional<double> thickness_mm = {};  ///< Of `query ior`: of the piece whose inside is asked about.
  bool arrays = false;                      ///< Lists of wavelengths stay lists where they hold only one.
};
/// Prints the index n + ik as catalogued. With a thickness d, also the share of the light between two faces
/// that reaches the second: exp(-4 pi k d / lambda). That and k are null where k is not measured.
int query_ior(const IndexOptions& options);
/// Angle of total reflection against air; null where n <= 1, and where the material absorbs
/// so much, 4 pi k >= 1, that no wave goes on within for a wavelength, as in metals.
int query_critical(const IndexOptions& options);
/// Angle of least R_p for light from outside, with that R_p: Brewster's, atan(n), where it is none; of what
/// absorbs the pseudo-Brewster angle, where it is not.
int query_brewster(const IndexOptions& options);

/// `query reflectance`: of a polished surface, perhaps under thin films, for light from air; with the phases
/// of the reflected fields, which go as exp(-i omega t) and of which that in the plane of incidence has the
/// sign of `FresnelAmplitudes`.
struct ReflectanceOptions {
  std::string name;
  std::vector<double> at_nm;
  std::vector<double> angles_deg{0};
  bool json = false;
  std::string coating = {};  ///< Films on it, from outside inwards, as "MATERIAL:NM,MATERIAL:NM".
  bool arrays = false;       ///< As of `IndexOptions`; lists of angles too.
};
int query_reflectance(const ReflectanceOptions& options);

/// `query prism`: minimum deviation in air, or the deviation at one incidence.
struct PrismOptions {
  std::string name;
  double apex_deg = 60;
  std::vector<double> at_nm;
  std::optional<double> incidence_deg;
  bool json = false;
  bool arrays = false;  ///< As of `IndexOptions`.
};
int query_prism(const PrismOptions& options);

/// How colours are summed: every nanometre, or by the weights of ASTM E308 at the measured wavelengths.
enum class ColorMethod { one_nm, astm_e308 };

/// `query color`: of a reflectance, or of the perfect diffuser when none is named.
struct ColorOptions {
  std::string illuminant;
  Observer observer = Observer::cie1931;
  std::string reflectance = {};
  bool json = false;
  ColorMethod method = ColorMethod::one_nm;
  std::optional<SumRange> range = {};  ///< Of `ColorMethod::one_nm`; ASTM E308 has its own.
};
/// Throws Error{usage} for a range with `ColorMethod::astm_e308`.
int query_color(const ColorOptions& options);

/// `query delta-e`: between two L*, a*, b*; the first is the standard.
struct DeltaEOptions {
  std::array<double, 3> lab1{};
  std::array<double, 3> lab2{};
  bool json = false;
};
/// CIEDE2000, CIE 1976 and 1994; CAM16-UCS and ITP of colours relative to a white D65, that of ITP at 203
/// cd/m^2.
int query_delta_e(const DeltaEOptions& options);

/// `query light`: of a lamp, or of pixels of a spectral image, perhaps through filters and from a surface.
struct LightOptions {
  std::string name;          ///< An illuminant, or a spectral EXR.
  std::string filters = {};  ///< Of `data/filter` or files, with commas between them.
  std::string reflectance = {};
  std::optional<Crop> crop = {};    ///< Of an image: these pixels, all it has without it.
  std::filesystem::path plot = {};  ///< SVG of the colour vector graphic; empty: none.
  bool samples = false;             ///< Print the fidelity of each of the 99 samples too.
  SumRange range = {};
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};
/// Prints chromaticity, colour temperature (null where there is none, and then what needs one),
/// efficacy, scotopic ratio, colour rendering and fidelity.
int query_light(const LightOptions& options);

/// `query metamerism`: of two reflectances that look alike in one light, in another.
struct MetamerismOptions {
  std::string first;
  std::string second;
  std::string reference = "D65";
  std::string test = "A";
  bool json = false;
  SumRange range = {};
};
int query_metamerism(const MetamerismOptions& options);

/// `query camera`: raw values of a reflectance, or of the perfect diffuser when none is named; or how near
/// the camera comes to an observer.
struct CameraOptions {
  std::string name;
  std::string illuminant;
  std::string reflectance;
  bool judge = false;  ///< Print the Vora value, what is left of x, y, z, and the sensitivity index instead.
  bool json = false;
  std::optional<ResponseKind> response = {};  ///< Of its curves; without one as `load_camera` takes them.
};
/// Throws Error{usage} without an illuminant unless the camera is to be judged.
int query_camera(const CameraOptions& options);

/// `query --list [KIND]`: the names of every kind, or of one; of matter, where it holds and its source too.
struct ListOptions {
  std::string kind;
  bool json = false;
};
int query_list(const ListOptions& options);
/// The kinds it knows.
[[nodiscard]] std::vector<std::string> name_kinds();

}  // namespace abbe::cli
