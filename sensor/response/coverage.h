#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "sensor/response/channel.h"
#include "spectral/coverage.h"

namespace abbe {

/// The wavelengths [nm] that a table of light or matter must cover before these channels: those of a
/// colorimetric sum, and all but what holds a negligible share of a channel's response (`main_range`).
[[nodiscard]] NeededRange needed_by(std::span<const Channel> channels);

/// What counts light, as messages call it, like 'channel "R"', by its weight.
struct Counter {
  std::string name;
  const Curve* weight;
};
[[nodiscard]] std::vector<Counter> counters_of(std::span<const Channel> channels);

/// Reports a table by whose ends a share of what a channel counts is lost that is not negligible: it is an
/// error where the table does not say what holds there, which gives false, and warned of where it says 0.
/// The channels, or other counters, count `light` by their weights; the table is part of the one or the
/// others, in which it goes on as it ends.
bool check_ends(const NamedCurve& table, const Curve& light, std::span<const Counter> counters,
                const SourcePosition& where, Diagnostics& diagnostics);
bool check_ends(const NamedCurve& table, const Curve& light, std::span<const Channel> channels,
                const SourcePosition& where, Diagnostics& diagnostics);

/// Warns of a light that is 0 beyond its table where channels count so much of it, and reports one that says
/// nothing of these wavelengths.
bool check_ends_of_light(const NamedCurve& light, std::span<const Channel> channels,
                         const SourcePosition& where, Diagnostics& diagnostics);

}  // namespace abbe
