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

/// Sets `Scene::output.white` to the white of the scene's film, by `white_of`, so that later calls of that
/// function return it without another pilot. Does nothing if the film has no colours. The pilot uses
/// `guides`, or trains them if null. `threads` is the number of its threads. Throws Error{scene}, which names
/// the scene file `path`, if the scene requests a white to which chromatic adaptation is impossible.
void resolve_white(Scene& scene, const std::filesystem::path& path, int threads = 1,
                   const std::shared_ptr<const GuidingData>& guides = {});

/// Records the white (`white_of`) in `identity`, and the chromaticities of all lights by name if there are at
/// most 256. `requested_white` can then find them. Does nothing if the film has no colours.
void add_white(const Scene& scene, FilmIdentity& identity);

/// A light that a film records.
struct RecordedLight {
  std::string name;
  std::optional<Chromaticity> xy;  ///< Empty if several lights have this name.
};
/// The lights that a film records; empty if it records none.
[[nodiscard]] std::vector<RecordedLight> recorded_lights(const Image& film);

/// Sets the white of a scene whose sensor is exposed to the spectral film `film`. It is the requested one,
/// else `output/white` of the scene, else the film's, else that of the scene's lights. `origin` names the
/// option or keyword of `requested`, a text as for `requested_white`. `path` is the scene file. The film's
/// bands become `Scene::image_band_edges_nm`. Throws Error{usage} for an unknown `requested` white, and
/// Error{scene} for one to which chromatic adaptation is impossible.
void resolve_white(Scene& scene, const std::filesystem::path& path, const Image& film,
                   const std::optional<std::string>& requested, std::string_view origin);

/// Parses a requested white in the syntax of `output/white`; it may name a light that the film records.
/// `origin` names the option or keyword of the request. Throws Error{usage} for an unknown white, and for one
/// to which chromatic adaptation is impossible.
[[nodiscard]] White requested_white(const std::string& text, const Image& film, std::string_view origin);

}  // namespace abbe
