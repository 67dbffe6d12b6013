#pragma once

#include <optional>

#include "description/sensor.h"

namespace abbe::description {

[[nodiscard]] std::optional<Camera> read_camera(const JsonValue& json, const Sensor& sensor,
                                                LoadContext& context);

}  // namespace abbe::description
