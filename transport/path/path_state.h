#pragma once

#include <cstdint>
#include <optional>

#include "sampling/sampler.h"
#include "scene/lights/light.h"
#include "scene/shapes/ray.h"
#include "transport/path/medium_at.h"
#include "transport/path/packet.h"

namespace abbe {

/// Homogeneous scattering segment of a ray, from its origin, with the path's state there.
struct MediumSegment {
  Ray ray;
  float length = 0;  ///< Length [m], which may be infinite; 0 if there is no segment.
  /// Sum over wavelengths of the path's pdf up to the origin, for `mis_weight`. Like the throughput it is
  /// relative to the pdf with which the hero wavelength sampled the path.
  float path_pdf = 0;
  Imath::V3f end_normal{0, 0, 0};  ///< Unit normal of the surface at its end; (0, 0, 0) if there is none.
};

/// Number of paths in a batch; their states fit into a near cache.
inline constexpr std::uint32_t kBatchSize = 64;

/// State of a path from the camera or a light: the ray on which it leaves its last vertex, and all that is
/// needed to continue it.
struct PathState {
  PathState(const Sampler& path_sampler, std::uint32_t batch_index)
      : sampler(path_sampler), index(batch_index) {}

  Ray ray;
  PathPacket packet;
  Sampler sampler;
  std::uint32_t index;  ///< Index within its batch.
  int depth = 0;        ///< Number of scattering events so far; kProbeDepth at a probe.
  /// Argument `path_pdf` of `mis_weight` if the next vertex is an emitter hit; 0 if next-event estimation
  /// could not have sampled it, as after a delta event.
  float nee_path_pdf = 0;
  LightSampleContext prev_context;  ///< The last vertex, as context for light sampling.
  /// Spare random numbers of the last event that may draw the next direction.
  std::optional<Imath::V2f> spare_u;
  /// Spare random numbers of the last event in a medium that draw the free path after it.
  std::optional<Imath::V2f> free_path_u;
  MediumState media;  ///< Media around the ray's origin, on the side to which the ray leaves.
  /// Segment that led to the last event, if that was in a medium; of length 0 in a medium with a grid.
  MediumSegment segment;

  [[nodiscard]] const SampledSpectrum& lambda_nm() const { return packet.wavelengths.lambda_nm; }
};

/// Direction in which the light travels if a path that carries `mode` travels along `along`: against it for
/// radiance, along it for power.
[[nodiscard]] inline Imath::V3f light_travels(const Imath::V3f& along, TransportMode mode) {
  return mode == TransportMode::radiance ? -along : along;
}

}  // namespace abbe
