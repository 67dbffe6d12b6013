#pragma once

#include <span>
#include <string>

#include "sensor/response/channel.h"

namespace abbe {

/// Spectral sensitivities of a camera as JSON text for rawtoaces and physlight, which fit ACES input
/// transforms to them. Contains the name `camera` and energy responses every 5 nm from 380 to 780 nm, with a
/// maximum of 1 over all channels, one of which must respond there. `read_camera_json` reads it.
[[nodiscard]] std::string sensitivities_json(const std::string& camera, std::span<const Channel> channels);

}  // namespace abbe
