#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "io/spectral_exr.h"
#include "scene/scene.h"
#include "transport/render/part.h"

namespace abbe {

/// What it takes to make radiances of the films of a scene whose sensor is spectral.
void add_spectral_identity(const Scene& scene, FilmIdentity& identity);

/// What a radiance is multiplied by to give the radiant exposure that the scene's sensor counts, pixel by
/// pixel [s sr].
[[nodiscard]] std::vector<double> exposure_per_radiance(const Scene& scene);

/// The film of a spectral sensor as radiances in the layout of spectral files, with their preview.
[[nodiscard]] Image spectral_film_image(const Image& film);

/// The film of a scene's sensor that looks at the radiances read from `path` through the scene's camera, with
/// the metadata of both; with a mosaic, its one plane. Warns of channels that respond beyond the image's
/// bands. Throws Error{input} when sensor and image have different pixels or fields of view, or a channel
/// sees nothing of the bands, Error{usage} for a scene whose sensor is spectral itself, and for a channel
/// whose response depends on the angle of incidence, which the image does not record.
[[nodiscard]] Image seen_by(const Scene& scene, const SpectralImage& image, const std::filesystem::path& path,
                            Diagnostics& diagnostics);

}  // namespace abbe
