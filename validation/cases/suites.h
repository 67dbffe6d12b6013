#pragma once

#include <span>
#include <string>
#include <vector>

#include "validation/cases/case.h"

namespace abbe {

/// Each function returns a group of cases, in the order of the report. The groups of a suite follow each
/// other. Some read shipped tables and throw Error{input} if one is missing.
/// Optics: refractive indices, Fresnel reflectances, critical angles and absorption.
[[nodiscard]] std::vector<Case> optics_cases();
/// Optics: rays through prisms, plates, balls and drops in double precision.
[[nodiscard]] std::vector<Case> traced_ray_cases();
/// Radiometry: rooms, form factors, spheres under a dome, slabs, prisms and Lambertian spheres.
[[nodiscard]] std::vector<Case> radiometry_cases();
/// Radiometry: integrating spheres, concentric spheres, parallel plates and furnaces.
[[nodiscard]] std::vector<Case> enclosure_cases();
/// Radiometry: light through balls and panes of glass.
[[nodiscard]] std::vector<Case> refraction_cases();
/// Radiometry: a deep scattering layer, and single scattering in fog.
[[nodiscard]] std::vector<Case> scattering_cases();
/// Colour: observers, white points, black bodies, daylight, colour differences and matrices of RGB spaces.
[[nodiscard]] std::vector<Case> colour_cases();
/// Colour: temperature, rendering and fidelity, appearance, differences for displays.
[[nodiscard]] std::vector<Case> color_metric_cases();
/// Colour: the ColorChecker integrated from its spectra, and its editions.
[[nodiscard]] std::vector<Case> chart_cases();
/// Colour: the ColorChecker rendered under several illuminants.
[[nodiscard]] std::vector<Case> rendered_chart_cases();
/// Camera: raw values and least-squares matrices of a measured camera.
[[nodiscard]] std::vector<Case> camera_cases();
/// Sensor: electron counts, a tilted filter and photon transfer.
[[nodiscard]] std::vector<Case> sensor_cases();

/// A `TechniqueMean` for each `FilmMean` of the list and each of `kIntegratorNames`, film by film. Only one
/// of the flat fields is included.
[[nodiscard]] std::vector<Case> technique_cases(const std::vector<Case>& films);

/// Measures a rendered chart: figures, margin, samples, remarks and picture. `run_case` adds the verdict, the
/// worst figure and the cost. Throws the errors of `run_case`.
[[nodiscard]] CaseResult measure(const Case& item, const RenderedChart& method, const CaseSettings& settings);

/// Loads a scene `file` of `data/scenes/validation` with overrides. Throws Error{internal}, which names the
/// case `id`, if it does not load.
[[nodiscard]] Scene load_case_scene(const std::string& id, const std::string& file,
                                    std::span<const Override> settings);

}  // namespace abbe
