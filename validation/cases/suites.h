#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "validation/cases/case.h"

namespace abbe {

/// Each function returns a group of cases, in the order of the report. The groups of a suite follow each
/// other. Some read shipped tables and throw Error{input} if one is missing.
/// Optics: formulas of materials and surfaces, then rays traced in double precision.
[[nodiscard]] std::vector<Case> optics_cases();
/// Radiometry: rooms, form factors, domes, slabs, enclosures, balls and panes of glass, scattering media.
[[nodiscard]] std::vector<Case> radiometry_cases();
/// Colour: observers, white points, black bodies, daylight, colour differences and matrices of RGB spaces.
[[nodiscard]] std::vector<Case> colour_cases();
/// Colour: temperature, rendering and fidelity, appearance, differences for displays.
[[nodiscard]] std::vector<Case> color_metric_cases();
/// Colour: the ColorChecker integrated from its spectra, its editions, and renders under several illuminants.
[[nodiscard]] std::vector<Case> chart_cases();
/// Camera: raw values and least-squares matrices of a measured camera.
[[nodiscard]] std::vector<Case> camera_cases();
/// Sensor: electron counts, a tilted filter and photon transfer.
[[nodiscard]] std::vector<Case> sensor_cases();

/// A `TechniqueMean` for each `FilmMean` of the list and each of `kIntegratorNames`, film by film. Only one
/// of the flat fields is included.
[[nodiscard]] std::vector<Case> technique_cases(const std::vector<Case>& films);

/// Measures a rendered chart. `run_case` adds the verdict, the worst figure and the cost. Throws the errors
/// of `run_case`.
[[nodiscard]] CaseResult measure(const Case& item, const RenderedChart& method, const CaseSettings& settings);

/// Loads a scene of `data/scenes/validation` with overrides. Throws Error{internal}, which names the case
/// `id`, if it does not load.
[[nodiscard]] Scene load_case_scene(const std::string& id, const std::string& file,
                                    std::span<const Override> settings);

/// Makes cases of a suite that are measured by `Computed`; the arguments are the members of `Case`.
struct ComputedCases {
  Suite suite;

  [[nodiscard]] Case operator()(std::string id, std::string title, std::string source, std::string unit,
                                Margin margin, std::function<Figures()> figures) const {
    return {suite,
            std::move(id),
            std::move(title),
            std::move(source),
            std::move(unit),
            margin,
            Computed{std::move(figures)}};
  }
};

/// Wavelength in air of the helium line d.
inline constexpr double kLineD_nm = 587.5618;

/// Case of the suite radiometry: the mean of a film's channel against a closed form. By default the channel
/// is Y, the illuminance times the exposure time [lx s]. The margin is 1 %, that of a thorough run 0.2 %.
/// `scene` is relative to `data/scenes/validation`; `samples` are per pixel.
[[nodiscard]] inline Case film_case(std::string id, std::string title, std::string source, std::string scene,
                                    std::vector<Override> settings, Expected expected, int samples,
                                    std::string channel = "Y") {
  return {Suite::radiometry,
          std::move(id),
          std::move(title),
          std::move(source),
          "lx s",
          {0.01, Margin::Kind::relative},
          FilmMean{std::move(scene), std::move(settings), std::move(channel), std::move(expected), samples,
                   0.002}};
}

/// Mean exposure behind a pinhole of f-number 1 with a square film, for unit luminance and exposure time:
/// pi/4 times the mean of cos^4 over the film [sr]. `fov_deg` is the full angle between opposite edges of the
/// film.
[[nodiscard]] double pinhole_exposure(double fov_deg);

/// Override that replaces the camera by an irradiance probe. It receives light from the side to which
/// `normal` points. Both are JSON arrays such as "[0, 0, 1]".
[[nodiscard]] Override probe_at(const std::string& point, const std::string& normal);

/// Integral by the midpoint rule with `steps` >= 1 intervals. Swapping a and b changes its sign.
template <typename Function>
[[nodiscard]] double midpoint_integral(const Function& f, double a, double b, int steps) {
  const double step = (b - a) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += f(a + (i + 0.5) * step);
  return sum * step;
}

}  // namespace abbe
