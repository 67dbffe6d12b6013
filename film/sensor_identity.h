#pragma once

#include "calibration/output/display.h"
#include "io/image.h"
#include "scene/scene.h"
#include "transport/render/part.h"

namespace abbe {

/// What a scene's sensor adds to the metadata of its films.
[[nodiscard]] FilmIdentity sensor_identity(const Scene& scene);

/// Takes what `shown_film` gives to pictures. Throws what `make_display` throws.
[[nodiscard]] DisplayTransform display_of(const Scene& scene, const ViewOptions& view = {});

/// A film as its file holds it: of a spectral sensor, radiances in the spectral layout and a preview R, G, B
/// [cd/m^2]; of any other its planes.
[[nodiscard]] Image film_image(const RenderPart& part);
/// What a display shows of it: of a mosaic, a plane for each channel.
[[nodiscard]] Image shown_film(const Scene& scene, const RenderPart& part);

}  // namespace abbe
