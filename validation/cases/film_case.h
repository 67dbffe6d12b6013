#pragma once

#include <string>
#include <utility>
#include <vector>

#include "validation/cases/case.h"

namespace abbe {

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

/// Override that replaces the camera by an irradiance probe at `point`. The probe receives light from the
/// side to which `normal` points. Both are JSON arrays of three numbers, such as "[0, 0, 1]".
[[nodiscard]] Override probe_at(const std::string& point, const std::string& normal);

}  // namespace abbe
