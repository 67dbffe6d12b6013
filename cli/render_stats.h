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

/// JSON that `abbe render --stats` writes. The cost of the command is that spent until this call.
/// `shown_as_white` is empty without a picture.
[[nodiscard]] std::string stats_text(const Scene& scene, const RenderResult& result, const Costs& costs,
                                     std::optional<double> shown_as_white);

}  // namespace abbe::cli
