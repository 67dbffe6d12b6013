#pragma once

#include <vector>

#include "io/image.h"
#include "sensor/film/film_planes.h"

namespace abbe {

/// Polarisation of the light in each pixel, row by row from the top, over all channels together. If the film
/// has colours, channels are weighted by their luminance, else equally. For a spectral film it is the
/// polarisation of the luminance. Throws Error{usage} if the film does not record polarisation, and as
/// `stokes_planes`.
[[nodiscard]] std::vector<PolarisationFigures> polarisation_of_light(const Image& film);

/// Polarisation of each channel C of a film, in channels `DoP.C`, `DoLP.C` and `AoLP.C`. They hold the degree
/// of polarisation, the degree of linear polarisation and its angle [degrees] (`PolarisationFigures`). Linear
/// polarisers cannot measure `DoP.C`, which is then absent. Throws as `polarisation_of_light`.
[[nodiscard]] Image polarisation_image(const Image& film);

/// Stokes vectors from channels behind linear polarisers at three or more angles, by least squares. Channels
/// of the same response form a group, named after its first channel C. The result has planes C (the value of
/// that channel for the same light unpolarised), S1.C and S2.C, in the film's unit. It has no S3.C, which
/// linear polarisers cannot measure. A mosaic is demosaicked first. Groups whose angles do not suffice have
/// no planes; a film without polarisers gives no planes at all.
[[nodiscard]] Image stokes_of_polarisers(const Image& film);

}  // namespace abbe
