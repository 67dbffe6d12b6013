#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "transport/plan/plan.h"
#include "transport/render/render.h"

namespace abbe {

/// Which light the film of the scene will lack, because no technique or not the chosen integrator reaches it,
/// as a sentence; nothing when it will lack none.
[[nodiscard]] std::optional<std::string> lost_light(const Scene& scene);

/// That the camera stands within opaque matter where no light is, or a meter on a light that it misses,
/// as a sentence; nothing when it does not.
[[nodiscard]] std::optional<std::string> dark_camera(const Scene& scene);

/// That a thin sheet, or all of a body of a medium, lies on something that is hit instead, as a sentence;
/// nothing when none does.
[[nodiscard]] std::optional<std::string> hidden_sheet(const Scene& scene);

/// That light is lost of a lamp which touches something opaque, as a sentence; nothing when none does.
[[nodiscard]] std::optional<std::string> hidden_lamp(const Scene& scene);

/// That the sensor measures how light is polarised in a scene that leaves polarisation out, as a sentence;
/// nothing when it does not.
[[nodiscard]] std::optional<std::string> unpolarised_measurement(const Scene& scene);

/// A sentence that too few pilot photons trained the photon guide, for all light or for more than 1 % of it,
/// so that the error of this light is uncertain; nothing if they were enough or no pilots were traced.
[[nodiscard]] std::optional<std::string> rare_photons(const Guides* guides);

/// A sentence on why the error of a film is not yet known, and what to do about it; nothing if it is known.
[[nodiscard]] std::optional<std::string> unknown_error(const RelativeError& error);

/// Which settings of the scene its integrator makes no use of, as a sentence; nothing when it uses all.
[[nodiscard]] std::optional<std::string> unused_settings(const Scene& scene);

/// What a render left out of the scene's film, a sentence each: samples that were not finite or more than
/// the film can hold, paths that were cut although the scene does not say so, and all light where none was
/// found on the whole film although lights emit what its sensor sees. Of the camera of `dark_camera`, and of
/// a crop, which may well be of what is black, the last is not told.
[[nodiscard]] std::vector<std::string> left_out(const Scene& scene, const RenderResult& result);

}  // namespace abbe
