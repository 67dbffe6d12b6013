#pragma once

#include <span>
#include <string>
#include <vector>

#include "validation/cases/case.h"

namespace abbe {

/// The cases of one suite each, in the order of the report.
[[nodiscard]] std::vector<Case> optics_cases();
[[nodiscard]] std::vector<Case> traced_ray_cases();
/// Rooms, form factors, integrating spheres, furnaces, slabs.
[[nodiscard]] std::vector<Case> radiometry_cases();
[[nodiscard]] std::vector<Case> enclosure_cases();
/// Balls and panes of glass, and matter that scatters.
[[nodiscard]] std::vector<Case> refraction_cases();
[[nodiscard]] std::vector<Case> scattering_cases();
[[nodiscard]] std::vector<Case> colour_cases();
/// Colour temperature, colour rendering and fidelity, appearance, differences for displays.
[[nodiscard]] std::vector<Case> judging_cases();
[[nodiscard]] std::vector<Case> chart_cases();
[[nodiscard]] std::vector<Case> rendered_chart_cases();
[[nodiscard]] std::vector<Case> camera_cases();
[[nodiscard]] std::vector<Case> sensor_cases();

/// The film cases of a list by every technique.
[[nodiscard]] std::vector<Case> technique_cases(const std::vector<Case>& films);

/// Measures a rendered chart, for `run_case` to judge.
[[nodiscard]] CaseResult measure(const Case& item, const RenderedChart& method, const CaseSettings& settings);

/// A scene of `data/scenes/validation`. Throws Error{internal} naming the case when it does not load.
[[nodiscard]] Scene load_case_scene(const std::string& id, const std::string& file,
                                    std::span<const Override> settings);

}  // namespace abbe
