#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include <ImathVec.h>

#include "materials/material.h"
#include "scene/scene.h"
#include "scene/surface.h"
#include "transport/path/packet.h"

namespace abbe {

/// A path's arrival at a surface, ready to scatter.
struct Vertex {
  SurfaceHit hit;
  Basis<float> frame;
  Imath::V3f wo;  ///< Local.
  Bsdf bsdf;

  /// Where a meter stands: white, diffuse, and seen along its normal, so that the radiance leaving it is the
  /// irradiance over pi.
  static Vertex meter(const Imath::V3f& point, const Imath::V3f& normal) {
    return {{point, normal, 0, 0}, Basis<float>(normal), {0, 0, 1}, DiffuseBsdf{SampledSpectrum(1.0F)}};
  }

  Vertex(const SurfaceHit& surface, const Basis<float>& axes, const Imath::V3f& outgoing, Bsdf scattering)
      : hit(surface), frame(axes), wo(outgoing), bsdf(std::move(scattering)) {}
  Vertex(const Scene& scene, const SurfaceHit& surface, const Imath::V3f& incoming,
         const SampledSpectrum& wavelengths_nm)
      : Vertex(scene, surface, place_of(scene, surface), incoming, wavelengths_nm) {}

 private:
  Vertex(const Scene& scene, const SurfaceHit& surface, const SurfacePlace& place, const Imath::V3f& incoming,
         const SampledSpectrum& wavelengths_nm)
      : hit(surface),
        frame(place.frame),
        wo(frame.to_local(-incoming)),
        bsdf(make_bsdf(scene.materials[scene.shapes[surface.shape].material], {wavelengths_nm, place.uv})) {}
};

/// Survival probability of Russian roulette, the same whichever lane is the hero: min(1, max(0.1, largest
/// throughput)), where the throughput counts what refraction into glass takes off radiance as still there.
/// [Marschner2021, sec. 14.4]
[[nodiscard]] inline float survival(const PathPacket& packet, float eta_scale) {
  const float throughput = packet.throughput.max() / packet.lane_pdf.max() * eta_scale;
  return std::min(1.0F, std::max(0.1F, throughput));
}

}  // namespace abbe
