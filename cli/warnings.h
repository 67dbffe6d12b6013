#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"
#include "transport/path/ray_trace.h"
#include "transport/plan/plan.h"

namespace abbe::cli {

/// Warns on stderr of the classes of paths that the scene's integrator does not reach, whose light the image
/// will lack. Throws Error{scene} instead, when `strict`.
void warn_of_lost_light(const Scene& scene, bool strict);

/// Warns of a camera that stands within opaque matter where no light is: Error{scene} when `strict`.
void warn_of_dark_camera(const Scene& scene, bool strict);

/// What is to be said of a material an index of which, or its extinction, is held from the end of its data at
/// a wavelength [nm], if one is.
[[nodiscard]] std::optional<std::string> held_index(const Material& material, double wavelength_nm);

/// What is to be said of the first index that a ray of a wavelength [nm] asked for beyond its data, if it
/// did.
[[nodiscard]] std::optional<std::string> held_index(const Scene& scene, const RayTree& tree,
                                                    double wavelength_nm);

/// Warns of neutrals that interference filters tint towards the corners of the picture.
void warn_of_tinted_corners(const Scene& scene);

/// Warns of a thin sheet that is lost where it lies on something: Error{scene} when `strict`.
void warn_of_hidden_sheet(const Scene& scene, bool strict);

/// Warns of a lamp that light is lost of where it touches something opaque: Error{scene} when `strict`.
void warn_of_hidden_lamp(const Scene& scene, bool strict);

/// Warns of photons that pilots found too few of to aim by, if pilots have taught guides at all.
void warn_of_rare_photons(const Guides* guides);

/// Warns of settings that the scene's integrator makes no use of.
void warn_of_unused_settings(const Scene& scene);

/// Says in a line, when the scene leaves polarisation out and has paths where that costs something, what it
/// costs.
void note_polarisation(const Scene& scene);

/// Warns of a sensor that measures polarisation in a scene that leaves it out: Error{scene} when `strict`.
void warn_of_unpolarised_measurement(const Scene& scene, bool strict);

}  // namespace abbe::cli
