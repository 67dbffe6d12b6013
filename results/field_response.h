#pragma once

#include <optional>
#include <vector>

#include "develop/white_field.h"
#include "scene/scene.h"

namespace abbe {

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
