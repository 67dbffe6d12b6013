#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <ImathVec.h>

#include "materials/interface/mueller.h"
#include "scene/scene.h"
#include "spectral/stokes.h"

namespace abbe {

/// Full Mueller matrix, for column vectors.
struct FullMueller {
  std::array<StokesVector, 4> rows;

  [[nodiscard]] static FullMueller identity();
  /// Matrix of an event that passes on the fraction `power` of unpolarised light, in the frame of the event's
  /// axis: `power` times the normalised `elements`.
  [[nodiscard]] static FullMueller of(const MuellerElements<double>& elements, double power);

  /// Stokes vector of `light` after the event.
  [[nodiscard]] StokesVector operator*(const StokesVector& light) const;
  /// Matrix of the event `before` followed by this one.
  [[nodiscard]] FullMueller operator*(const FullMueller& before) const;
  FullMueller& operator*=(double power);
};

/// Effect of a ray's events so far on the polarisation of its light.
struct RayPolarisation {
  FullMueller mueller = FullMueller::identity();  ///< From the first frame to the last one.
  Imath::V3d first_axis, last_axis;  ///< First axes of both frames: unit vectors perpendicular to the ray.

  /// State of a ray that starts along the unit vector `direction`. The first axis is horizontal,
  /// perpendicular to the ray and to z; for a ray along z it is x.
  explicit RayPolarisation(const Imath::V3d& direction)
      : first_axis(across(direction, {0, 0, 1})), last_axis(first_axis) {}

  /// Rotates the last frame to `axis`, which is perpendicular to the unit vector `direction` along which the
  /// light travels.
  void turn_to(const Imath::V3d& axis, const Imath::V3d& direction);
};

/// Reflection or refraction at a smooth surface. Indices are relative to air; n_to is that of the other side,
/// even for a reflected ray.
struct Passage {
  double n_from;  ///< Index of the side from which the ray arrives.
  double n_to;    ///< 0 for a mirror without an index.
  double k_to;    ///< Extinction coefficient of the other side; 0 for dielectrics.
  /// Angles of the incident and the outgoing ray with the normal on their sides, in [0, 90].
  double angle_in_deg, angle_out_deg;
  double Rs, Rp;  ///< Reflected fractions of the power of s- and p-polarised light.
};

/// Effect of an event on the polarisation of the light, on the branch that is followed.
struct EventPolarisation {
  /// First axis of the frames before and after the event, perpendicular to both directions.
  Imath::V3d axis;
  FullMueller mueller;  ///< Its first element is the fraction of unpolarised power that continues.
  StokesVector stokes;  ///< Stokes vector after the event; the light starts with I = 1.
};

/// Event of a traced ray.
struct TraceEvent {
  /// Reaction of the followed ray: `refract` includes straight transmission, `hit` ends it on a surface, and
  /// `escape` leaves the scene.
  enum class Kind { refract, reflect, total_reflection, hit, escape };
  Kind kind;
  ShapeHit<double> at;                  ///< Undefined for `escape`.
  std::uint32_t shape = 0;              ///< Index into `Scene::shapes`; undefined for `escape`.
  std::optional<Passage> passage = {};  ///< Set if the ray continues.
  double power_fraction = 1;            ///< Fraction of the ray's initial power that arrives here.
  /// Fractions of the arriving power that are reflected and transmitted in single directions.
  double R = 0, T = 0;
  std::optional<EventPolarisation> polarisation = {};  ///< Set if the ray continues.
};

/// Events of a single ray.
struct RayTrace {
  std::vector<TraceEvent> events;  ///< Events in the order of the ray; medium boundaries are no events.
  BasicRay<double> last;           ///< Position and direction with which the ray ended or left the scene.
  bool truncated;                  ///< True if the ray still continued after the maximum number of events.
  RayPolarisation polarisation;    ///< From the start of the ray, including the branches before this one.
};

/// Outgoing ray to follow at a surface that reflects and transmits.
enum class Follow { refraction, reflection, both };

/// Limits at which tracing stops.
struct FollowLimits {
  /// Maximum number of events along each chain from the start of the ray. A branch inherits the count of its
  /// parent, so this does not limit the sum over all branches.
  int max_events = 64;
  /// Branches with a smaller fraction of the initial power are truncated, except for the main branch.
  double min_power_fraction = 1e-6;
  std::size_t max_branches = 10000;  ///< Number of branches, with the main one.
};

/// Branch of a ray, from the event at which it split off another branch.
struct RayBranch {
  RayTrace trace;          ///< Events of this branch alone.
  BasicRay<double> start;  ///< Ray at the start of the branch.
  double power_fraction;   ///< Fraction of the ray's initial power at the start of the branch.
  std::size_t from = 0;    ///< Index of the branch from which it split off; 0 for the main branch.
  std::size_t event = 0;   ///< Index of the event on that branch.
};

/// All traced branches of a ray: the main one first, then the others by falling power. Power that does not
/// end on a surface escapes, is absorbed, or is in `truncated_power`.
struct RayTree {
  std::vector<RayBranch> branches;
  std::size_t truncated = 0;   ///< Number of branches that the limits ended or excluded.
  double truncated_power = 0;  ///< Fraction of the initial power in those branches.
};

/// Traces one ray in double precision, with the intersection code of the shapes, through all surfaces that
/// send light in single directions. Smooth dielectrics refract it, panes and medium boundaries transmit it
/// straight, metals, mirrors and coats reflect it. A surface without such directions ends it. Coordinates are
/// those of the scene [m].
/// - `Follow::refraction` reflects only if nothing is transmitted. A surface that also scatters, such as a
///   coated diffuse one, ends the ray.
/// - `Follow::reflection` transmits only if nothing is reflected. Surfaces that also scatter do not end it.
/// - `Follow::both` follows each branch like `refraction`, and traces every other outgoing ray as a new
///   branch.
///
/// Polarisation is carried from surface to surface: power fractions are those of light that starts with the
/// Stokes vector `light`, I = 1, in the first frame of `RayPolarisation`. Media attenuate by absorption and
/// scattering. The ray's direction must be a unit vector. Throws Error{resource} if more than
/// `MediumStack::kMaxShapes` media nest. Meshes with polarisers or wave plates end a ray, because a hit has
/// no coordinates for their axis.
[[nodiscard]] RayTree follow_ray(const Scene& scene, const BasicRay<double>& ray, double wavelength_nm,
                                 Follow follow, const FollowLimits& limits,
                                 const StokesVector& light = {1, 0, 0, 0});

/// Main branch of `follow_ray` with `Follow::refraction` and unpolarised light, up to `max_events` events.
[[nodiscard]] RayTrace trace_ray(const Scene& scene, const BasicRay<double>& ray, double wavelength_nm,
                                 int max_events);

/// Angle between two vectors of any positive length [degrees], in [0, 180]; accurate for small angles.
[[nodiscard]] double angle_deg(const Imath::V3d& a, const Imath::V3d& b);

}  // namespace abbe
