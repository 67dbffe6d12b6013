#pragma once

#include <vector>

#include "validation/cases/case.h"

namespace abbe {

/// The cases of one suite each, in the order of the report.
[[nodiscard]] std::vector<Case> optics_cases();
[[nodiscard]] std::vector<Case> traced_ray_cases();
/// Rooms, form factors, integrating spheres, furnaces, slabs.
[[nodiscard]] std::vector<Case> radiometry_cases();
[[nodiscard]] std::vector<Case> enclosure_cases();
[[nodiscard]] std::vector<Case> colour_cases();
[[nodiscard]] std::vector<Case> chart_cases();
[[nodiscard]] std::vector<Case> camera_cases();
[[nodiscard]] std::vector<Case> sensor_cases();

}  // namespace abbe
