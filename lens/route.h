#pragma once

#include <cstddef>
#include <vector>

#include "lens/system.h"

namespace abbe::lens {

/// Interaction of light with a surface: its direction of travel on arrival, and reflection or transmission.
struct Encounter {
  bool forwards = true;
  bool reflects = false;
};

/// Sequence of surfaces that light passes or is reflected by, from the object to the image.
struct Step {
  std::size_t surface;
  Encounter how;
};
using Route = std::vector<Step>;

/// Route through all surfaces in their order, which forms the image.
[[nodiscard]] Route direct_route(std::size_t surfaces);

/// Route of light that one surface reflects back and an earlier one forwards again.
struct Ghost {
  std::size_t first;   ///< Surface of the first reflection.
  std::size_t second;  ///< Surface of the second reflection, nearer to the object.
  double reflectance;  ///< Product of both reflectances at normal incidence, averaged over the wavelengths.
};
[[nodiscard]] Route route_of(const Ghost& ghost, std::size_t surfaces);

/// All ghosts of two reflections at surfaces with a coating or a change of index, for wavelengths from
/// `low_nm` to `high_nm`.
[[nodiscard]] std::vector<Ghost> ghosts(const System& system, double low_nm, double high_nm);

/// Paraxial image of an axial object point by a ghost.
struct GhostFocus {
  double image_distance_mm;  ///< Distance from the last vertex; infinite for parallel light.
  double diameter_mm;  ///< Beam diameter in the image plane, limited by the stop and the clear apertures on
                       ///< the route; infinite if nothing limits it.
};
/// Paraxial y-nu trace in which a reflection reverses the sign of the index [Welford1986].
[[nodiscard]] GhostFocus ghost_focus(const SystemAt& at, const Ghost& ghost, double stop_radius_mm);

}  // namespace abbe::lens
