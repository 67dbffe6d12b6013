#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sensor/response/channel.h"

namespace abbe {

/// A plane of a film that measures Stokes vectors: which of the components 0 to 3 of the light that a channel
/// of the sensor responds to.
struct StokesPlane {
  int component;
  std::string channel;
};
/// "R" of the intensity that channel R counts, "S1.R", "S2.R" and "S3.R" of the other components.
[[nodiscard]] std::string name_of(const StokesPlane& plane);
/// The reverse; names of ordinary channels, which have no dot, are those of intensities.
[[nodiscard]] StokesPlane stokes_plane(std::string_view name);

/// The channels, which count intensities, and after them all with their responses to the components 1, 2 and
/// 3 in turn. None may have an analyser.
[[nodiscard]] std::vector<Channel> with_stokes(std::vector<Channel> channels);

/// Whether the channel counts light; that of another component of the Stokes vector has a sign.
[[nodiscard]] inline bool counts_light(const Channel& channel) {
  return !channel.analyser || channel.analyser->i > 0;
}
[[nodiscard]] std::size_t count_intensities(std::span<const Channel> channels);
/// The channels that count light, which come before all others.
[[nodiscard]] std::vector<Channel> intensities(std::span<const Channel> channels);
/// The names that are those of intensities.
[[nodiscard]] std::vector<std::string> intensities(std::span<const std::string> planes);
/// Whether some channel tells polarised light from unpolarised light.
[[nodiscard]] bool any_analyser(std::span<const Channel> channels);

}  // namespace abbe
