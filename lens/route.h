#pragma once

#include <cstddef>
#include <vector>

#include "lens/system.h"

namespace abbe::lens {

/// Interaction of light with a surface.
struct Encounter {
  bool forwards = true;   ///< True if the light arrives travelling towards +z.
  bool reflects = false;  ///< True for reflection, false for transmission.
};

/// A surface on a route, and how light interacts with it.
struct Step {
  std::size_t surface;  ///< Index from 0.
  Encounter how;
};
/// Sequence of surfaces that transmit or reflect light on its way from the object to the image.
using Route = std::vector<Step>;

/// Route through all surfaces in their order, which forms the image.
[[nodiscard]] Route direct_route(std::size_t surfaces);

/// Light that one surface reflects back and an earlier one forwards again.
struct Ghost {
  std::size_t first;   ///< Surface of the first reflection, at least 1.
  std::size_t second;  ///< Surface of the second reflection, less than `first`.
  double reflectance;  ///< Product of both reflectances at normal incidence, averaged over the wavelengths.
};
[[nodiscard]] Route route_of(const Ghost& ghost, std::size_t surfaces);

/// All ghosts of two reflections at surfaces with a coating or a change of index, ordered by `first`, then by
/// `second`. Reflectances are averaged over nine evenly spaced wavelengths from `low_nm` to `high_nm`.
[[nodiscard]] std::vector<Ghost> ghosts(const System& system, double low_nm, double high_nm);

/// Paraxial image of an axial object point by a ghost.
struct GhostFocus {
  /// Distance of the image behind the last vertex, negative if it is in front; infinite for parallel light.
  double image_distance_mm;
  /// Diameter of the axial beam in the image plane of the lens, limited by the stop and the clear apertures
  /// on the route; infinite if nothing limits it.
  double diameter_mm;
};
/// Uses a paraxial y-nu trace, in which a reflection reverses the sign of the index [Welford1986].
[[nodiscard]] GhostFocus ghost_focus(const SystemAt& at, const Ghost& ghost, double stop_radius_mm);

}  // namespace abbe::lens
