#pragma once

#include <optional>

#include "io/json.h"
#include "sensor/readout/readout.h"

namespace abbe {

/// The electronics that an object as a scene's `sensor/readout` describes. Everything wrong with it is
/// reported; nothing is returned if there is an error.
[[nodiscard]] std::optional<Readout> read_readout(const JsonValue& json, Diagnostics& diagnostics);

}  // namespace abbe
