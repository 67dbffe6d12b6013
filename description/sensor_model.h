#pragma once

#include "description/load_context.h"

namespace abbe::description {

/// Merges the file of a camera sensor into a scene whose `sensor` has the key `model`. The value is the name
/// of a file of `data/sensor`, or a user's `FILE.json`. Such a file is an object with `title`, `source`,
/// `status` and `sensor`; the last has the keys of a scene's sensor.
/// Keys of the scene replace those of the file; in `readout` each key separately. A scene that sets the
/// channels, the gain or the speed replaces all keys of the file with that meaning.
/// `scene` is the root of the scene's JSON; it stays unchanged without such a key, and after an error.
/// Reports an unknown name and the errors of the file to `context.diagnostics`. The file is recorded in
/// `context`.
void include_sensor_model(JsonValue& scene, LoadContext& context);

}  // namespace abbe::description
