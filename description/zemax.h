#pragma once

#include <filesystem>
#include <optional>

#include "description/lens.h"

namespace abbe::description {

/// Reads a sequential lens of Zemax (`.zmx`, in UTF-8, UTF-16 or Windows-1252): title, unit, aperture (ENPD,
/// FNUM, FLOA), fields along y (angles, object heights, paraxial image heights), wavelengths, and of surfaces
/// STANDARD and EVENASPH curvature, thickness, glass, conic constant, coefficients, stop and clear apertures.
/// Glasses are looked for in the catalogues that the file names, else in all, which is told. Whatever else
/// would change the way of light is an error at its line; coatings, vignetting factors and weights of
/// wavelengths are told as left out.
[[nodiscard]] std::optional<spec::Lens> read_zemax(const std::filesystem::path& file,
                                                   Diagnostics& diagnostics);

}  // namespace abbe::description
