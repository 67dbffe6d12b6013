#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "io/schema/fields.h"
#include "sensor/readout/readout.h"

namespace abbe::spec {

struct Gain : schema::Value<double> {};
struct IsoSpeed : schema::Located<double> {};

/// The electronics as a scene's `sensor/readout` says them.
struct Readout {
  abbe::Readout numbers;  ///< All of them but what follows.
  std::variant<std::monostate, Gain, IsoSpeed> conversion;
  std::optional<int> bits;
  std::optional<schema::Located<double>> saturation_dn;
  schema::Located<double> offset_dn;
  std::optional<schema::Located<std::vector<std::array<double, 2>>>> response_curve;
  SourcePosition where;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Readout>);

}  // namespace abbe::spec

namespace abbe {

/// Reports an offset that leaves no codes, a curve that does not increase, and a speed that the full well or
/// the lack of a sensitivity makes impossible; nothing then. The sensitivity [electrons per lx s of daylight]
/// is that of a pixel of the most sensitive channel.
[[nodiscard]] std::optional<Readout> build(const spec::Readout& readout, std::optional<double> sensitivity,
                                           Diagnostics& diagnostics);

/// The electronics that an object as a scene's `sensor/readout` describes, of a sensor of that sensitivity.
/// Everything wrong with it is reported; nothing is returned if there is an error.
[[nodiscard]] std::optional<Readout> read_readout(const JsonValue& json, std::optional<double> sensitivity,
                                                  Diagnostics& diagnostics);

}  // namespace abbe
