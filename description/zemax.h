#pragma once

#include <filesystem>
#include <optional>

#include "description/lens.h"

namespace abbe::description {

/// Reads a sequential lens of Zemax (`.zmx`, in UTF-8, UTF-16 or Windows-1252). It reads:
/// - title, unit, aperture (ENPD, FNUM, FLOA) and wavelengths;
/// - fields along y: angles, object heights, paraxial image heights;
/// - of STANDARD and EVENASPH surfaces: curvature, thickness, glass, conic constant, coefficients, stop and
///   clear aperture.
/// Glasses are looked up in the catalogues that the file names, else in all catalogues, with a warning.
/// Coatings, vignetting factors and weights of wavelengths are ignored with a warning. Any other data that
/// would change the light paths is an error at its line. Lengths of the result are in mm, whatever the file's
/// unit. Errors and warnings go to `diagnostics`; returns nothing if they then have an error.
[[nodiscard]] std::optional<spec::Lens> read_zemax(const std::filesystem::path& file,
                                                   Diagnostics& diagnostics);

}  // namespace abbe::description
