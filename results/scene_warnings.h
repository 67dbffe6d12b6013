#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "transport/plan/plan.h"
#include "transport/render/render.h"

namespace abbe {

// Each function of an optional text returns nothing if there is nothing to warn of.

/// A warning about light paths that the chosen integrator, or any, cannot sample, so that the film lacks
/// them.
[[nodiscard]] std::optional<std::string> unsampled_light_warning(const Scene& scene);

/// A warning if the camera is inside an opaque shape without lights, or if a meter coincides with a light
/// whose emission it does not receive.
[[nodiscard]] std::optional<std::string> dark_camera_warning(const Scene& scene);

/// A warning if a thin sheet, a light, or the whole surface of a medium coincides with a shape that rays hit
/// instead. It names the first pair of shapes and counts the others.
[[nodiscard]] std::optional<std::string> coincidence_warning(const Scene& scene);

/// A warning if the sensor measures polarisation but the scene disables it.
[[nodiscard]] std::optional<std::string> ignored_polarisation_warning(const Scene& scene);

/// A warning if too few pilot photons contributed to train the photon guides: for all light, or for more than
/// 1 % of it. nullptr means that no pilot was traced.
[[nodiscard]] std::optional<std::string> undertrained_warning(const GuidingData* guides);

/// A warning that explains why the error of a film is not yet known, and what to do.
[[nodiscard]] std::optional<std::string> unknown_error_warning(const RelativeError& error);

/// A warning about photon settings of the scene that its integrator does not use.
[[nodiscard]] std::optional<std::string> unused_settings_warning(const Scene& scene);

/// Warnings about the finished film of a scene:
/// - samples dropped because they were not finite or too large for the film;
/// - paths cut although the scene sets no depth limit;
/// - a film that received no light although lights emit in the sensor's range. This is not reported for a
///   crop, which may be black, or for a camera in a `dark_enclosure`.
[[nodiscard]] std::vector<std::string> render_warnings(const Scene& scene, const RenderResult& result);

}  // namespace abbe
