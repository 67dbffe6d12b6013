#pragma once

#include <array>
#include <optional>
#include <vector>

#include "io/schema/fields.h"
#include "sensor/readout/readout.h"

namespace abbe::spec {

/// The electronics as a scene's `sensor/readout` says them.
struct Readout {
  abbe::Readout numbers;  ///< All of them but what follows.
  schema::Located<double> offset_dn;
  std::optional<schema::Located<std::vector<std::array<double, 2>>>> response_curve;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Readout>);

}  // namespace abbe::spec

namespace abbe {

/// Reports an offset that leaves no codes, and a curve that does not increase; nothing then.
[[nodiscard]] std::optional<Readout> build(const spec::Readout& readout, Diagnostics& diagnostics);

/// The electronics that an object as a scene's `sensor/readout` describes. Everything wrong with it is
/// reported; nothing is returned if there is an error.
[[nodiscard]] std::optional<Readout> read_readout(const JsonValue& json, Diagnostics& diagnostics);

}  // namespace abbe
