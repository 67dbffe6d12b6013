#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "sensor/response/channel.h"
#include "spectral/library.h"

namespace abbe {

/// Wavelengths [nm] that a table of a light or material must cover for these channels: 380 to 780 nm, and the
/// `main_range` of each channel.
[[nodiscard]] NeededRange needed_by(std::span<const Channel> channels);

/// Weight of a response, which is not owned, and its name in messages, such as 'channel "R"'.
struct NamedResponse {
  std::string name;
  const Curve* weight;
};
/// Responses of the channels by their weights. The channels must outlive them.
[[nodiscard]] std::vector<NamedResponse> named_responses(std::span<const Channel> channels);

/// Checks that a table covers all but `kNegligibleFraction` of the integral of |weight x light| for each
/// response. The table is a factor of `light` or of the weights, where the caller has extrapolated it by
/// constants. Returns true without a check for a table that declares `clamp`. Otherwise, if too much lies
/// outside,
/// - a table that declares 0 causes a warning;
/// - a table without a declared extrapolation causes an error with the code `input`, and the result is false.
bool check_table_range(const NamedCurve& table, const Curve& light, std::span<const NamedResponse> responses,
                       const SourcePosition& where, Diagnostics& diagnostics);

/// Checks that the table of a light covers all but a negligible fraction of the response of each channel.
/// Reports and returns like `check_table_range`.
bool check_light_range(const NamedCurve& light, std::span<const Channel> channels,
                       const SourcePosition& where, Diagnostics& diagnostics);

}  // namespace abbe
