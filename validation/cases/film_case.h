#pragma once

#include <string>
#include <utility>
#include <vector>

#include "validation/cases/case.h"

namespace abbe {

/// Case of the suite radiometry: the mean of a film's channel against a closed form. By default the channel
/// is Y, the illuminance times the exposure time.
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

/// Mean exposure behind a pinhole of f-number 1 with a square field of view, for unit radiance: pi/4 times
/// the mean of cos^4.
[[nodiscard]] double pinhole_exposure(double fov_deg);

/// Override that replaces the camera by an irradiance probe at `point` with the given normal, both as JSON
/// arrays.
[[nodiscard]] Override probe_at(const std::string& point, const std::string& normal);

}  // namespace abbe
