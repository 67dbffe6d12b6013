#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "sensor/response/channel.h"
#include "spectral/coverage.h"

namespace abbe {

/// Wavelengths [nm] that a table of a light or material must cover for these channels: those of a
/// colorimetric sum, and the `main_range` of each channel.
[[nodiscard]] NeededRange needed_by(std::span<const Channel> channels);

/// Weight of a response, and its name in messages, such as 'channel "R"'.
struct NamedResponse {
  std::string name;
  const Curve* weight;
};
[[nodiscard]] std::vector<NamedResponse> named_responses(std::span<const Channel> channels);

/// Checks that a table covers all but a negligible fraction of the responses to `light`. Otherwise, if the
/// table declares no extrapolation, reports an error and returns false. If it declares 0, warns. Either the
/// light or the weights contain the table, extrapolated by constants.
bool check_table_range(const NamedCurve& table, const Curve& light, std::span<const NamedResponse> responses,
                       const SourcePosition& where, Diagnostics& diagnostics);
bool check_table_range(const NamedCurve& table, const Curve& light, std::span<const Channel> channels,
                       const SourcePosition& where, Diagnostics& diagnostics);

/// Checks that the table of a light covers all but a negligible fraction of the response of each channel.
/// Reports like `check_table_range`.
bool check_light_range(const NamedCurve& light, std::span<const Channel> channels,
                       const SourcePosition& where, Diagnostics& diagnostics);

}  // namespace abbe
