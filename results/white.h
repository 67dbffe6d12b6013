#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "develop/relight.h"
#include "develop/white_field.h"
#include "io/image.h"
#include "scene/scene.h"
#include "scene/white.h"
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

/// Sets the white of a scene whose sensor is exposed to the spectral film `film`. It is the requested one,
/// else `output/white` of the scene, else the film's, else that of the scene's lights. `origin` names the
/// option or keyword of `requested`, a text as for `requested_white`. `path` is the scene file. The film's
/// bands become `Scene::image_band_edges_nm`. Throws Error{usage} for an unknown `requested` white, and
/// Error{scene} for one to which chromatic adaptation is impossible.
void resolve_white(Scene& scene, const std::filesystem::path& path, const Image& film,
                   const std::optional<std::string>& requested, std::string_view origin);

/// Parses a requested white in the syntax of `output/white`; it may name a light that the film records.
/// `origin` names the option or keyword. Throws Error{usage} for an unknown white, and for one to which
/// chromatic adaptation is impossible.
[[nodiscard]] White requested_white(const std::string& text, const Image& film, std::string_view origin);

/// The white of a film whose lights are to be scaled.
struct RelitWhite {
  std::optional<White> white;  ///< The new main light; empty if the film's white remains.
  /// A limitation of the pictures, or the reason for an unknown white; empty if there is none.
  std::string warning;
};

/// The white after `relight` with these factors, for a film that still has its layers of lights. A film shows
/// its main light as white; lights of one colour count together, within the pilot's noise. The white remains
/// in these cases:
/// - the scene requests it;
/// - it is not that of the light with the largest contribution to the film, as may happen in a crop;
/// - its light still has the largest contribution;
/// - the film does not record the colour of the new main light.
/// Factors of planes change the contribution of a light, not its recorded colour. Throws Error{usage} as
/// `relight`.
[[nodiscard]] RelitWhite relit_white(const Image& film, std::span<const LightFactor> factors);

/// The scene's channels with their responses at the centre of the field: the mean over the angles of
/// incidence there (`incidence_angles`). Channels whose filters do not depend on the angle are unchanged. If
/// no light arrives at the centre, all are.
[[nodiscard]] std::vector<Channel> channels_at_center(const Scene& scene);

/// Response to the scene's white (`white_of`) over the field of its camera: nine rows at equal steps from the
/// centre of the film to its corner. Empty unless the sensor has three channels that count light and depend
/// on the angle of incidence. Also empty if a channel receives none of the white at some position.
[[nodiscard]] std::optional<WhiteField> white_field(const Scene& scene);

/// The `neutral_shift` (CIEDE2000) of the result of `white_field`, in the colours of the scene's pictures.
/// Empty if that result is empty or the sensor has no pictures.
[[nodiscard]] std::optional<double> neutral_shift(const Scene& scene);

}  // namespace abbe
