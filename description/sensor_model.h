#pragma once

#include "description/load_context.h"

namespace abbe::description {

/// Puts what a file says of a camera's sensor in the place of `sensor/model` of a scene: the name of a file
/// of `data/sensor`, or a user's `FILE.json`, an object with `title`, `source`, `status` and `sensor`, which
/// has the keys of a scene's. Keys of the scene replace those of the file, in `readout` one by one; what the
/// scene's sensor counts, or its gain or speed, replaces all that the file says of it. Reports an unknown
/// name and what is wrong with the file.
void include_sensor_model(JsonValue& scene, LoadContext& context);

}  // namespace abbe::description
