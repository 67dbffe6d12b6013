#pragma once

#include <cstdint>
#include <optional>

#include "sampling/sampler.h"
#include "scene/lights/light.h"
#include "scene/shapes/ray.h"
#include "transport/path/medium_at.h"
#include "transport/path/packet.h"

namespace abbe {

/// A stretch of even matter that scatters, along a ray from its origin, and what a path has come there with.
struct Stretch {
  Ray ray;
  float length = 0;                ///< [m], perhaps infinite; 0 where there is none.
  float lanes = 0;                 ///< Sum of the lane densities at its origin, in the unit of the path's.
  Imath::V3f end_normal{0, 0, 0};  ///< Unit, of the surface at its end; 0 where it ends at none.
};

/// How many paths take each step together: as many as a near cache holds.
inline constexpr std::uint32_t kPathsTogether = 64;

/// A path of either direction under way: the ray it leaves its last vertex on, and all that is needed to go
/// on from there.
struct Walk {
  Walk(const Sampler& numbers, std::uint32_t number) : sampler(numbers), path(number) {}

  Ray ray;
  PathPacket packet;
  Sampler sampler;
  std::uint32_t path;  ///< Its number among those traced together.
  int events = 0;      ///< That it has had between its ends; kMeterEvent at a meter.
  /// What `mis_weight` takes as `connected`, were the path's next vertex its end; 0 where no connection was
  /// possible, as after an event of a single direction.
  float connected = 0;
  LightSampleContext last;              ///< The vertex it left.
  std::optional<Imath::V2f> left_over;  ///< Numbers of its last event that may draw the next direction.
  std::optional<Imath::V2f> free_path;  ///< Those of one within matter that draw how far it comes from there.
  Surroundings around;
  Stretch stretch;  ///< In which it was scattered, after an event within matter.

  [[nodiscard]] const SampledSpectrum& lambda_nm() const { return packet.wavelengths.lambda_nm; }
};

/// The unit vector along which light travels where a path that carries that quantity goes along another.
[[nodiscard]] inline Imath::V3f light_travels(const Imath::V3f& along, TransportMode mode) {
  return mode == TransportMode::radiance ? -along : along;
}

}  // namespace abbe
