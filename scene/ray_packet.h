#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "scene/embree_query.h"
#include "scene/exact_query.h"

namespace abbe {

/// The first `count` rays of a context as an Embree packet of `kPacket`; `count` is in [1, `kPacket`].
/// `valid` is -1 for these and 0, which disables, for the rest. `mask` selects the geometry: `kOpaque`,
/// `kBoundary` or ~0U for both. Ray `id`s are indices into the context.
struct alignas(32) Packet {
  std::array<int, kPacket> valid;
  RTCRayHit8 query;

  Packet(const ExactContext& context, std::size_t count, unsigned mask) {
    for (std::size_t i = 0; i < kPacket; ++i) {
      valid[i] = i < count ? -1 : 0;
      const RTCRay ray = embree_ray(context.rays[std::min(i, count - 1)]);
      query.ray.org_x[i] = ray.org_x;
      query.ray.org_y[i] = ray.org_y;
      query.ray.org_z[i] = ray.org_z;
      query.ray.dir_x[i] = ray.dir_x;
      query.ray.dir_y[i] = ray.dir_y;
      query.ray.dir_z[i] = ray.dir_z;
      query.ray.tnear[i] = 0;
      query.ray.time[i] = ray.time;
      query.ray.tfar[i] = ray.tfar;
      query.ray.mask[i] = mask;
      query.ray.id[i] = static_cast<unsigned>(i);
      query.ray.flags[i] = 0;
      query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
  }
  /// Distance of the hit of ray `i` in units of its direction; its t_max if there is none.
  [[nodiscard]] float t(std::size_t i) const { return query.ray.tfar[i]; }
  /// Hit of ray `i` in Embree's format for single rays; valid only if its `geomID` is not the invalid one.
  [[nodiscard]] RTCHit hit(std::size_t i) const {
    RTCHit one{};
    one.u = query.hit.u[i];
    one.v = query.hit.v[i];
    one.primID = query.hit.primID[i];
    one.geomID = query.hit.geomID[i];
    one.instID[0] = query.hit.instID[0][i];
    return one;
  }
};

}  // namespace abbe
