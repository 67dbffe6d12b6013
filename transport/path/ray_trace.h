#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/scene.h"
#include "transport/path/ray_polarisation.h"

namespace abbe {

/// What a smooth surface does to a ray. Indices are relative to air; n_to is that of the other side, which a
/// reflected ray does not enter.
struct Passage {
  double n_from;
  double n_to;  ///< 0 of a mirror without an index.
  double k_to;  ///< Extinction of the other side; 0 for dielectrics.
  double angle_in_deg, angle_out_deg;
  double Rs, Rp;
};

/// What an event did to polarised light on the way that is followed.
struct EventPolarisation {
  Imath::V3d axis;      ///< The first axis of the frames before and after the event, across both directions.
  FullMueller mueller;  ///< Whose first element is what unpolarised light keeps of its power.
  StokesVector stokes;  ///< What goes on, the light that set out having I = 1.
};

/// One thing that happened to a ray.
struct TraceEvent {
  enum class Kind { refract, reflect, total_reflection, hit, escape };
  Kind kind;
  ShapeHit<double> at;  ///< Nothing of it holds for `escape`.
  std::uint32_t shape = 0;
  std::optional<Passage> passage = {};  ///< Of a smooth surface.
  double share = 1;                     ///< Of the ray's power at its start, what arrives.
  double R = 0, T = 0;                  ///< Of what arrives, what goes on reflected and through.
  std::optional<EventPolarisation> polarisation = {};  ///< Where the ray goes on.
};

/// A ray's whole way.
struct RayTrace {
  std::vector<TraceEvent> events;
  BasicRay<double> last;  ///< Where the ray ended or left from, and its direction there.
  bool cut_short;         ///< Still going after as many events as were allowed.
  PolarisedWay way;       ///< From the start of the ray, all its branches included.
};

/// Which way is followed where a surface both reflects and lets through.
enum class Follow { refraction, reflection, both };

/// Where following ends.
struct FollowLimits {
  int max_events = 64;        ///< From the start of the ray, through all branches.
  double least_share = 1e-6;  ///< Of the power; branches of less are cut, but not the main one.
  std::size_t most_branches = 10000;
};

/// One of the ways of a ray, from the event at which it parted from another.
struct RayBranch {
  RayTrace trace;
  BasicRay<double> start;
  double share;           ///< Of the ray's power, what sets out.
  std::size_t from = 0;   ///< The branch it parted from, an earlier one; of the main branch itself.
  std::size_t event = 0;  ///< At this event of that.
};

/// All the ways of a ray that were followed: first the main one, then the others, those of more power first.
/// What does not end on surfaces is in what escapes, in what is absorbed and in `cut_share`.
struct RayTree {
  std::vector<RayBranch> branches;
  std::size_t cut = 0;   ///< Branches that end, or do not begin, as the limits forbid to go on.
  double cut_share = 0;  ///< Their power.
};

/// Follows one ray in double precision by the shapes' own code, through every surface that sends light on in
/// single directions: refracted by smooth dielectrics, straight on through panes and boundaries of matter,
/// reflected by metals, mirrors and coats. Surfaces that scatter end it. `Follow::refraction` reflects it
/// only where nothing is let through, `Follow::reflection` lets it through only where nothing is reflected,
/// and `Follow::both` follows refraction in the main branch, which ends at a surface that also scatters, and
/// every other way in a branch of its own. Coordinates are the scene's own [m].
///
/// Polarisation is carried from surface to surface: shares of power are those of light that sets out with the
/// Stokes vector `light`, I = 1, in the frame that a `PolarisedWay` starts from. On the way between surfaces
/// matter takes what it absorbs and scatters. Meshes of polarisers and wave plates end a ray, as a hit does
/// not tell the coordinates that their axis needs.
[[nodiscard]] RayTree follow_ray(const Scene& scene, const BasicRay<double>& ray, double wavelength_nm,
                                 Follow follow, const FollowLimits& limits,
                                 const StokesVector& light = {1, 0, 0, 0});

/// The main branch alone, as `Follow::refraction` has it.
[[nodiscard]] RayTrace trace_ray(const Scene& scene, const BasicRay<double>& ray, double wavelength_nm,
                                 int max_events);

/// Angle between two directions of any length, accurate for small angles too [degrees].
[[nodiscard]] double angle_deg(const Imath::V3d& a, const Imath::V3d& b);

}  // namespace abbe
