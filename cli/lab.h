#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/inputs.h"
#include "spectral/colorimetry.h"

namespace abbe::cli {

/// Options of `abbe lab`.
struct LabOptions {
  std::string material;  ///< Material, as `load_material` takes it.
  std::vector<double> at_nm{450, 550, 650};
  std::vector<double> angles_deg{0, 15, 30, 45, 60, 75, 85};
  bool inside = false;  ///< The beam arrives from inside the material.
  std::string illuminant = "D65";
  Observer observer = Observer::cie1931;
  int samples = 1 << 13;
  std::filesystem::path plot{};  ///< SVG of the lobes; empty for none.
  std::filesystem::path map{};   ///< Picture of the hemispheres; empty for none.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// Measures a material on the BSDF bench: reflectance and transmittance over angle and wavelength,
/// reciprocity, energy conservation, sampling and colours. Returns the exit code.
int lab(const LabOptions& options);

}  // namespace abbe::cli
