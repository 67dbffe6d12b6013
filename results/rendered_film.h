#pragma once

#include <cstddef>
#include <filesystem>

#include "calibration/output/display.h"
#include "io/image.h"
#include "scene/scene.h"
#include "transport/render/part.h"

namespace abbe {

/// Extension of files that hold exact sums.
inline constexpr const char* kPartExtension = ".abbepart";

/// Attributes of a film of the scene rendered with these options. The path `scene_file` contributes its file
/// name only.
[[nodiscard]] FilmIdentity identity_of(const Scene& scene, const std::filesystem::path& scene_file,
                                       const RenderOptions& options);

/// Memory [bytes] of the exact sums of the scene's film, with those of layers and features.
[[nodiscard]] std::size_t film_bytes(const Scene& scene, const RenderOptions& options = {});

/// Writes the exact sums if the extension is `.abbepart`, else the film's image as an EXR file
/// (`film_image`). Throws Error{output}.
void write_film(const std::filesystem::path& path, const RenderPart& part);

/// Attributes that describe a scene's sensor, its camera and its white in the metadata of its films. They may
/// need a pilot of `white_of`. A sensor without pictures is no error: `kNoPictureKey` records the reason.
[[nodiscard]] FilmIdentity film_attributes(const Scene& scene);

/// Transforms the result of `film_for_display` to pictures, by the channels at the centre of the field and
/// the scene's white. Throws Error{usage} as `make_display` and `camera_matrix`; a spectral sensor always has
/// pictures.
[[nodiscard]] DisplayTransform display_of(const Scene& scene, const ViewOptions& view = {});

/// The planes of a film, with its metadata, in the form that its file has. For a spectral sensor, which the
/// metadata declare, these are radiances in the spectral layout and a preview R, G, B [cd/m^2]. Other planes
/// are unchanged.
[[nodiscard]] Image film_image(Image planes);
/// The film of a part in the form that its file has, with variance, layers (planes LAYER.PLANE) and features.
[[nodiscard]] Image film_image(const RenderPart& part);
/// The planes of a film file to display: a mosaic is demosaicked to a plane for each channel.
[[nodiscard]] Image film_for_display(const Scene& scene, Image film);

}  // namespace abbe
