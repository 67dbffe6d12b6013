#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"
#include "transport/render/cost.h"
#include "transport/render/render.h"

namespace abbe::cli {

/// Cost of the command, and of its phases other than the render itself.
struct Costs {
  CostMeter command;  ///< The whole command so far; starts with the construction of this struct.
  Cost load;          ///< Reading and building the scene.
  Cost plan;     ///< Pilot rays that choose the integrator, train its guiding data and determine the white.
  Cost display;  ///< Making and writing pictures of the film.
  Cost write;    ///< Writing the film and the last checkpoint.
};

/// JSON that `abbe render --stats` writes: one line with a newline. The cost of the command is that until
/// this call. `display_white` is the film value that the picture displays as white (`kDisplayExposureKey`);
/// null without a picture.
[[nodiscard]] std::string stats_text(const Scene& scene, const RenderResult& result, const Costs& costs,
                                     std::optional<double> display_white);

}  // namespace abbe::cli
