#pragma once

#include <string>
#include <utility>
#include <vector>

#include "validation/cases/case.h"

namespace abbe {

/// A case of radiometry: the mean illuminance times time of a film, or another channel's mean, in closed
/// form.
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

/// What a pinhole of f-number 1 and a square field of view makes of unit radiance: pi/4 times the mean of
/// cos^4.
[[nodiscard]] double pinhole_exposure(double fov_deg);

/// A probe at a point, facing along `normal`.
[[nodiscard]] Override probe_at(const std::string& point, const std::string& normal);

}  // namespace abbe
