#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"
#include "transport/render/cost.h"
#include "transport/render/render.h"

namespace abbe::cli {

/// Of the command, and of what comes before and after the render itself.
struct Costs {
  CostMeter command;
  Cost load;     ///< Reading the scene and building what it describes.
  Cost plan;     ///< The pilots that choose the integrator, teach it and find the white.
  Cost display;  ///< Making pictures of the film, and writing them.
  Cost write;    ///< Writing the film and the last checkpoint.
};

/// What `abbe render --stats` writes, as JSON; its command's cost is what was spent until now. Without a
/// picture there is no film value that it shows as white.
[[nodiscard]] std::string stats_text(const Scene& scene, const RenderResult& result, const Costs& costs,
                                     std::optional<double> shown_as_white);

}  // namespace abbe::cli
