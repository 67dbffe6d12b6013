#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace abbe {

/// What a smooth surface does to a ray. Indices are relative to air; n_to is that of the other side, which a
/// reflected ray does not enter.
struct Passage {
  double n_from, n_to;
  double k_to;  ///< Extinction of the other side; 0 for dielectrics.
  double angle_in_deg, angle_out_deg;
  double Rs, Rp;
};

/// One thing that happened to a ray.
struct TraceEvent {
  enum class Kind { refract, reflect, total_reflection, hit, escape };
  Kind kind;
  ShapeHit<double> at;  ///< Nothing of it holds for `escape`.
  std::uint32_t shape = 0;
  std::optional<Passage> passage;  ///< Of a smooth surface.
};

/// A ray's whole way.
struct RayTrace {
  std::vector<TraceEvent> events;
  BasicRay<double> last;  ///< Where the ray ended or left from, and its direction there.
  bool cut_short;         ///< Still going after as many events as were allowed.
};

/// Follows one ray in double precision by the shapes' own code: refracted by dielectrics where they let it
/// pass, straight on through boundaries of matter, reflected by metals, ended by other surfaces. Coordinates
/// are the scene's own [m].
[[nodiscard]] RayTrace trace_ray(const Scene& scene, const BasicRay<double>& ray, double wavelength_nm,
                                 int max_events);

/// Angle between two directions of any length, accurate for small angles too [degrees].
[[nodiscard]] double angle_deg(const Imath::V3d& a, const Imath::V3d& b);

}  // namespace abbe
