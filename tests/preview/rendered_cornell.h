#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "results/rendered_film.h"
#include "tests/scenes/scene_fixture.h"
#include "transport/render/part.h"

namespace abbe::test {

struct RenderedScene {
  Scene scene;
  RenderPart part;
};

/// The rendered Cornell box with some settings replaced.
inline RenderedScene rendered_cornell(const std::vector<Override>& settings, std::optional<Crop> crop = {}) {
  Scene scene = load("cornell.json", settings);
  RenderResult result = render(scene, {.threads = 2, .crop = crop});
  RenderPart part{identity_of(scene, "cornell.json", {}), std::move(result)};
  return {std::move(scene), std::move(part)};
}

}  // namespace abbe::test
