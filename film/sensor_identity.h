#pragma once

#include "calibration/output/display.h"
#include "io/image.h"
#include "scene/scene.h"
#include "transport/render/part.h"

namespace abbe {

/// What a scene's sensor adds to the metadata of its films.
[[nodiscard]] FilmIdentity sensor_identity(const Scene& scene);

/// Takes what `shown_film` gives to pictures, by the channels at the centre of the field. Throws what
/// `make_display` throws.
[[nodiscard]] DisplayTransform display_of(const Scene& scene, const ViewOptions& view = {});

/// The planes of a film as its file holds them, told by their metadata: of a spectral sensor, radiances in
/// the spectral layout and a preview R, G, B [cd/m^2]; of any other themselves.
[[nodiscard]] Image film_image(Image planes);
/// The same of a part, with its variance, its layers and its features.
[[nodiscard]] Image film_image(const RenderPart& part);
/// What a display shows of a film as its file holds it: of a mosaic, a plane for each channel.
[[nodiscard]] Image shown_film(const Scene& scene, Image film);

}  // namespace abbe
