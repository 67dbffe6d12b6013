#pragma once

#include <span>
#include <string>
#include <vector>

#include "validation/cases/case.h"

namespace abbe {

/// Cases of each suite, in the order of the report.
[[nodiscard]] std::vector<Case> optics_cases();
[[nodiscard]] std::vector<Case> traced_ray_cases();
/// Rooms, form factors, spheres under a dome, slabs, prisms and Lambertian spheres.
[[nodiscard]] std::vector<Case> radiometry_cases();
/// Integrating spheres, concentric spheres, parallel plates and furnaces.
[[nodiscard]] std::vector<Case> enclosure_cases();
/// Balls and panes of glass, and scattering media.
[[nodiscard]] std::vector<Case> refraction_cases();
[[nodiscard]] std::vector<Case> scattering_cases();
[[nodiscard]] std::vector<Case> colour_cases();
/// Colour temperature, colour rendering and fidelity, appearance, colour differences for displays.
[[nodiscard]] std::vector<Case> color_metric_cases();
[[nodiscard]] std::vector<Case> chart_cases();
[[nodiscard]] std::vector<Case> rendered_chart_cases();
[[nodiscard]] std::vector<Case> camera_cases();
[[nodiscard]] std::vector<Case> sensor_cases();

/// Each film case of the list, rendered by every integrator.
[[nodiscard]] std::vector<Case> technique_cases(const std::vector<Case>& films);

/// Measures a rendered chart; `run_case` adds the verdict.
[[nodiscard]] CaseResult measure(const Case& item, const RenderedChart& method, const CaseSettings& settings);

/// Loads a scene of `data/scenes/validation`. Throws Error{internal} that names the case if it does not load.
[[nodiscard]] Scene load_case_scene(const std::string& id, const std::string& file,
                                    std::span<const Override> settings);

}  // namespace abbe
