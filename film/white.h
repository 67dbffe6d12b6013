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

/// Sets the white of the scene's film (`white_of`) in the scene, so that later calls agree. Throws
/// Error{scene} if the scene requests a white to which chromatic adaptation is impossible.
void resolve_white(Scene& scene, const std::filesystem::path& path, int threads = 1,
                   const std::shared_ptr<const GuidingData>& guides = {});

/// Records the white in `identity`, with the chromaticities of up to 256 lights, which `requested_white` can
/// then find by name.
void add_white(const Scene& scene, FilmIdentity& identity);

/// A light that a film records. Several lights of one name have no chromaticity.
struct RecordedLight {
  std::string name;
  std::optional<Chromaticity> xy;
};
/// The lights that a film records; empty if it records none.
[[nodiscard]] std::vector<RecordedLight> recorded_lights(const Image& film);

/// Sets the white of a scene whose sensor is exposed to a spectral film. It is the requested one, else the
/// film's, else that of the scene's lights. `origin` names the option or keyword of the request.
void resolve_white(Scene& scene, const std::filesystem::path& path, const Image& film,
                   const std::optional<std::string>& requested, std::string_view origin);

/// Parses a requested white in the syntax of `output/white`, with the lights that the film records. `origin`
/// names the option or keyword of the request. Throws Error{usage} for an unknown white, and for one to which
/// chromatic adaptation is impossible.
[[nodiscard]] White requested_white(const std::string& text, const Image& film, std::string_view origin);

}  // namespace abbe
