#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sensor/response/channel.h"

namespace abbe {

/// Name of the plane of a film with a component (0 to 3 for I, Q, U and V) of the light to which a channel
/// responds: "R" for the intensity of channel R, "S1.R", "S2.R" and "S3.R" for Q, U and V.
[[nodiscard]] std::string stokes_plane_name(int component, std::string_view channel);

/// The channels, which measure intensities, followed by copies that respond to component 1, then 2, then 3.
/// No channel may have an analyser.
[[nodiscard]] std::vector<Channel> with_stokes(std::vector<Channel> channels);

/// Number of channels that measure intensities. The other components of a Stokes vector are signed.
[[nodiscard]] std::size_t count_intensities(std::span<const Channel> channels);
/// Channels that measure intensities, which precede all others.
[[nodiscard]] std::vector<Channel> intensities(std::span<const Channel> channels);
/// Names of intensity planes: those without the prefix of another component.
[[nodiscard]] std::vector<std::string> intensities(std::span<const std::string> planes);
/// True if a channel depends on polarisation.
[[nodiscard]] bool any_analyser(std::span<const Channel> channels);

/// Row of a channel behind a polariser for light (I, Q, U) of constant spectrum: weight (I + q Q + u U), in
/// the frame of the film.
struct PolariserRow {
  std::string group;  ///< Name of the first channel with a proportional response.
  double weight = 1;  ///< Integral of the weight relative to that channel.
  double q = 0;       ///< cos 2a for a polariser at the angle a, times the mean contrast.
  double u = 0;       ///< sin 2a, times the mean contrast.
};

/// Row of each channel behind a polariser, in the order of the channels. Nothing for other channels, and for
/// a channel whose weight has an integral of 0.
[[nodiscard]] std::vector<std::optional<PolariserRow>> polariser_rows(std::span<const Channel> channels);

/// Prefix of the attribute with the row of a channel; the name of the channel follows.
inline constexpr const char* kAnalyserKey = "analyser.";

/// Text of a row, such as "I0 1 0.99 0": the group, which has no blanks, and the numbers.
[[nodiscard]] std::string to_text(const PolariserRow& row);
/// Parses such a text; nothing if it is malformed.
[[nodiscard]] std::optional<PolariserRow> parse_polariser_row(std::string_view text);

}  // namespace abbe
