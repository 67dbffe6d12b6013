#pragma once

#include <vector>

#include "sensor/film/stokes_film.h"

namespace abbe {

/// How the light of each pixel is polarised, all channels together: as the eye weighs them where the film
/// knows colours, else added up. Throws Error{usage} for a film that does not measure polarisation.
[[nodiscard]] std::vector<PolarisationFigures> polarisation_of_light(const Image& film);

/// The same of each channel C of a film: channels `DoP.C`, `DoLP.C` and `AoLP.C`, the degree, the degree of
/// linear polarisation and its angle in degrees; without the first where linear polarisers have measured it.
/// Throws the same.
[[nodiscard]] Image polarisation_image(const Image& film);

}  // namespace abbe
