#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "io/schema/fields.h"
#include "sensor/readout/readout.h"

namespace abbe::spec {

/// Key `gain_e_per_dn`: conversion gain K [electrons per DN].
struct Gain : schema::Value<double> {};
/// Key `iso`: saturation-based ISO speed that determines the gain.
struct IsoSpeed : schema::Located<double> {};

/// Description of the electronics in `sensor/readout` of a scene.
struct Readout {
  abbe::Readout numbers;  ///< All numbers without a member of their own below.
  std::variant<std::monostate, Gain, IsoSpeed> conversion;  ///< Nothing if a camera model gives it.
  std::optional<int> bits;                                  ///< Nothing if a camera model gives it.
  std::optional<schema::Located<double>> saturation_dn;
  schema::Located<double> offset_dn;
  std::optional<schema::Located<std::vector<std::array<double, 2>>>> response_curve;
  SourcePosition where;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Readout>);

}  // namespace abbe::spec

namespace abbe {

/// Builds the electronics from a complete description. `sensitivity` is that of a pixel of the most sensitive
/// channel [electrons per lx s of daylight]. It is needed only for an ISO speed. Reports errors with the code
/// `scene` and returns nothing for
/// - missing bits, and neither a gain nor a speed;
/// - a highest code that the bits exclude, or an offset that leaves no codes;
/// - a curve that does not increase from (0, 0) to (1, 1);
/// - a speed that the full well or the lack of a sensitivity makes impossible.
[[nodiscard]] std::optional<Readout> build(const spec::Readout& readout, std::optional<double> sensitivity,
                                           Diagnostics& diagnostics);

/// Reads and builds the electronics from a JSON object like `sensor/readout` of a scene.
[[nodiscard]] std::optional<Readout> read_readout(const JsonValue& json, std::optional<double> sensitivity,
                                                  Diagnostics& diagnostics);

}  // namespace abbe
