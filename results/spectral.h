#pragma once

#include <filesystem>
#include <vector>

#include "io/diagnostics.h"
#include "io/spectral_exr.h"
#include "scene/scene.h"
#include "transport/render/part.h"

namespace abbe {

/// Adds to `identity` the attributes needed to convert films of a spectral sensor to radiances. The scene's
/// sensor must be spectral.
void add_spectral_identity(const Scene& scene, FilmIdentity& identity);

/// Radiant exposure on the scene's sensor per unit of radiance [s sr], for each pixel, row by row from the
/// top. It includes the mean transmission of the shutter.
[[nodiscard]] std::vector<double> exposure_per_radiance(const Scene& scene);

/// The film of a spectral sensor as radiances of the bands [W/(m^2 sr)] in the layout of spectral files, with
/// a preview R, G, B [cd/m^2]. The film must have the attributes of `add_spectral_identity`.
[[nodiscard]] Image spectral_film_image(const Image& film);

/// Exposes a scene's sensor to the radiances read from `path`, through the scene's camera. The film has the
/// metadata of both; with a mosaic it has one plane. Warns of channels that respond outside the image's
/// bands. Throws Error{input} if sensor and image differ in size or field of view, or a channel does not
/// respond inside the bands. Throws Error{usage} if the scene's sensor is spectral itself. Throws it also if
/// a channel depends on the angle of incidence, or on polarisation, and the image does not record it.
[[nodiscard]] Image expose_radiances(const Scene& scene, const SpectralImage& image,
                                     const std::filesystem::path& path, Diagnostics& diagnostics);

}  // namespace abbe
