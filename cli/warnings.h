#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"
#include "transport/path/ray_trace.h"
#include "transport/plan/plan.h"

namespace abbe::cli {

/// Warns on stderr of path classes that the scene's integrator cannot sample, so that their light is missing
/// from the image. Throws Error{scene} instead if `strict`.
void warn_of_unsampled_light(const Scene& scene, bool strict);

/// Warns of a camera inside an opaque body, where no light arrives. Throws Error{scene} instead if `strict`.
void warn_of_dark_camera(const Scene& scene, bool strict);

/// Warning for a material whose index or extinction is extrapolated at a wavelength [nm]; empty if neither
/// is.
[[nodiscard]] std::optional<std::string> extrapolated_index_warning(const Material& material,
                                                                    double wavelength_nm);

/// Warning for the first extrapolated index on the path of a ray of this wavelength [nm]; empty if there is
/// none.
[[nodiscard]] std::optional<std::string> extrapolated_index_warning(const Scene& scene, const RayTree& tree,
                                                                    double wavelength_nm);

/// Warns of neutral surfaces that interference filters tint towards the corners of the picture by more than a
/// CIEDE2000 of 1.
void warn_of_tinted_corners(const Scene& scene);

/// Warns of a sheet or light that is ineffective because it coincides with another surface. Throws
/// Error{scene} instead if `strict`.
void warn_of_coincidence(const Scene& scene, bool strict);

/// Warns if the pilot photons were too few to train the guiding data. Nothing happens without guiding data.
void warn_of_undertrained_guides(const GuidingData* guides);

/// Warns of settings that the scene's integrator does not use.
void warn_of_unused_settings(const Scene& scene);

/// Prints a note on the error of the image if the scene turns polarisation off and has paths that it affects.
void note_polarisation(const Scene& scene);

/// Warns of a sensor that measures polarisation in a scene that turns it off. Throws Error{scene} instead if
/// `strict`.
void warn_of_ignored_polarisation(const Scene& scene, bool strict);

}  // namespace abbe::cli
