#pragma once

#include <span>
#include <string>

#include "sensor/response/channel.h"

namespace abbe {

/// A camera's spectral sensitivities as rawtoaces and physlight take them, which fit an ACES input transform
/// to them by themselves: energy responses every 5 nm from 380 to 780 nm, the greatest of all being 1;
/// `read_camera_json` reads it. Text of JSON.
[[nodiscard]] std::string sensitivities_json(const std::string& camera, std::span<const Channel> channels);

}  // namespace abbe
