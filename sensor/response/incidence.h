#pragma once

#include <span>

#include "sensor/response/channel.h"

namespace abbe {

/// An angle of incidence on the film, and the fraction of a pixel's irradiance that arrives under it.
struct Incidence {
  double cos_film;
  double fraction;
};

/// The channel as a pixel responds to light that arrives under several angles: its weight is the mean over
/// them, and depends on no angle any more. `angles` is not empty, and its fractions add up to 1.
[[nodiscard]] Channel averaged(Channel channel, std::span<const Incidence> angles);

/// True if the weight of some channel depends on the angle of incidence.
[[nodiscard]] bool any_angular(std::span<const Channel> channels);

}  // namespace abbe
