#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/image.h"
#include "scene/scene.h"
#include "spectral/colorimetry.h"
#include "transport/plan/plan.h"
#include "transport/render/part.h"

namespace abbe {

/// Decides what pictures of the scene's film show as white (`white_of`), once for all that ask. Throws
/// Error{scene} when the scene asks for one to which no eye adapts.
void settle_white(Scene& scene, const std::filesystem::path& path, int threads = 1,
                  const std::shared_ptr<const Guides>& guides = {});

/// Adds it to what a film tells of itself, with the chromaticities of up to 256 lights, by which
/// `asked_white` finds them.
void add_white(const Scene& scene, FilmIdentity& identity);

/// A light that a film tells of: several of one name have no colour of theirs.
struct RecordedLight {
  std::string name;
  std::optional<Chromaticity> xy;
};
[[nodiscard]] std::vector<RecordedLight> recorded_lights(const Image& film);

/// The white of the sensor of a scene that looks at a spectral film: the one it asks for, else the film's,
/// else that of its own lights. `said_by` is the option or the keyword that asks.
void settle_white(Scene& scene, const std::filesystem::path& path, const Image& film,
                  const std::optional<std::string>& asked, std::string_view said_by);

/// The white asked for as `output/white` has it, lights being those a film tells of; by the option or the
/// keyword `said_by`. Throws Error{usage} for an unknown one, and for one to which no eye adapts.
[[nodiscard]] White asked_white(const std::string& text, const Image& film, std::string_view said_by);

}  // namespace abbe
