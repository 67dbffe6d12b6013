#pragma once

#include <vector>

#include "sensor/film/film_planes.h"

namespace abbe {

/// Polarisation of the light in each pixel, row by row from the top, over all channels together. If the film
/// has colours, channels are weighted by their luminance, else equally. For a spectral film it is the
/// polarisation of the luminance. Throws Error{usage} if the film does not record polarisation, and as
/// `stokes_planes`.
[[nodiscard]] std::vector<PolarisationFigures> polarisation_of_light(const Image& film);

/// Polarisation of each channel C of a film, in channels `DoP.C`, `DoLP.C` and `AoLP.C`. They hold the degree
/// of polarisation, the degree of linear polarisation and its angle [degrees] (`PolarisationFigures`). Linear
/// polarisers cannot measure `DoP.C`, which is then absent. Throws Error{usage} if the film does not record
/// polarisation, and as `stokes_planes`.
[[nodiscard]] Image polarisation_image(const Image& film);

}  // namespace abbe
