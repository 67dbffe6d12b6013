#pragma once

#include <optional>
#include <vector>

#include "develop/white_field.h"
#include "scene/scene.h"

namespace abbe {

/// The scene's channels as they respond at the centre of the field: each weight is the mean over the angles
/// of incidence there (`incidence_angles`). Channels whose filters do not depend on the angle are unchanged.
[[nodiscard]] std::vector<Channel> channels_at_center(const Scene& scene);

/// The response to the scene's white over the field of its camera. Nothing for a sensor other than of three
/// channels that count light, for channels that do not depend on the angle, and where a channel gets nothing
/// of the white somewhere.
[[nodiscard]] std::optional<WhiteField> white_field(const Scene& scene);

/// The `neutral_shift` of that field in the colours of the scene's pictures; nothing where there is no field
/// or no picture.
[[nodiscard]] std::optional<double> neutral_shift(const Scene& scene);

}  // namespace abbe
