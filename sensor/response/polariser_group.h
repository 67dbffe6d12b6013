#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sensor/response/channel.h"

namespace abbe {

/// What a channel behind a polariser counts of light (I, Q, U), whatever its spectrum is taken to be even:
/// weight (I + q Q + u U).
struct PolariserRow {
  std::string group;  ///< Name of the first channel of its response over wavelength.
  double weight = 1;  ///< Over that channel's.
  double q = 0;
  double u = 0;
};

/// Those of all channels that are behind polarisers, and nothing for the others, in the order of the
/// channels.
[[nodiscard]] std::vector<std::optional<PolariserRow>> polariser_rows(std::span<const Channel> channels);

/// What the key begins with under which a film has the row of a channel, before its name.
inline constexpr const char* kAnalyserKey = "analyser.";

/// A row in words, as "I0 1 0.99 0": the group, which has no blanks, and the numbers.
[[nodiscard]] std::string to_text(const PolariserRow& row);
/// The row of such words; nothing for others.
[[nodiscard]] std::optional<PolariserRow> parse_polariser_row(std::string_view text);

}  // namespace abbe
