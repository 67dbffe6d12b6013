#pragma once

#include <span>

#include "sensor/response/channel.h"

namespace abbe {

/// An angle of incidence on the film, and the fraction of a pixel's irradiance that arrives under it.
struct Incidence {
  double cos_film;
  double fraction;
};

/// Channel of a pixel that receives light under several angles: its weight is the mean over them and no
/// longer depends on the angle. `angles` must not be empty, and its fractions must add up to 1.
[[nodiscard]] Channel averaged(Channel channel, std::span<const Incidence> angles);

/// True if the weight of some channel depends on the angle of incidence.
[[nodiscard]] bool any_angular(std::span<const Channel> channels);

}  // namespace abbe
