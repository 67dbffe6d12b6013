#pragma once

#include <span>

#include "sensor/response/channel.h"

namespace abbe {

/// An angle of incidence on the film, and the fraction of a pixel's irradiance that arrives under it.
struct Incidence {
  double cos_film;  ///< Cosine of the angle to the normal of the film, in (0, 1].
  double fraction;  ///< In [0, 1].
};

/// Channel of a pixel that receives light under several angles: its weight is the mean over them and no
/// longer depends on the angle. A channel that does not depend on it stays unchanged. `angles` must not be
/// empty, and its fractions must add up to 1.
[[nodiscard]] Channel averaged(Channel channel, std::span<const Incidence> angles);

/// True if the weight of some channel depends on the angle of incidence.
[[nodiscard]] bool any_angular(std::span<const Channel> channels);

}  // namespace abbe
