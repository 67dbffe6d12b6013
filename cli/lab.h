#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/inputs.h"
#include "spectral/colorimetry.h"

namespace abbe::cli {

/// Options of `abbe lab`.
struct LabOptions {
  std::string material;                                       ///< Material, as `load_material` takes it.
  std::vector<double> at_nm{450, 550, 650};                   ///< Wavelengths in standard air.
  std::vector<double> angles_deg{0, 15, 30, 45, 60, 75, 85};  ///< Angles of incidence, in [0, 90).
  /// True if the beam arrives from inside the material, on the side opposite to the normal.
  bool inside = false;
  std::string illuminant = "D65";  ///< Illuminant of the colours.
  Observer observer = Observer::cie1931;
  int samples = 1 << 13;         ///< Samples per angle and packet of eight wavelengths.
  std::filesystem::path plot{};  ///< SVG of the lobes (.svg); empty for none.
  /// Picture of the hemispheres in a format of `write_picture` (.png, .jpg or .tif); empty for none.
  std::filesystem::path map{};
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;  ///< Print the answer as JSON instead of a table.
};

/// Measures a material on the BSDF bench: reflectance and transmittance over angle and wavelength,
/// reciprocity, energy conservation, sampling and colours. Prints a table or JSON, and writes `plot` and
/// `map`. Returns 0. Throws InvalidInput for an invalid material or illuminant. Throws Error{scene} if the
/// formulas of a transparent material do not hold at a wavelength of `at_nm`. Throws Error{usage} if
/// `plot` does not end in .svg, or if an output is the same file as an input or the other output. Throws
/// Error{output} for outputs that cannot be written, and for a `map` of unknown format.
int lab(const LabOptions& options);

}  // namespace abbe::cli
