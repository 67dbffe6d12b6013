#pragma once

#include <cstddef>
#include <vector>

#include "lens/system.h"

namespace abbe::lens {

/// How light meets a surface: on its way towards +z or back, to cross it or to be reflected.
struct Encounter {
  bool forwards = true;
  bool reflects = false;
};

/// A way of light from the object to the image, surface by surface.
struct Step {
  std::size_t surface;
  Encounter how;
};
using Route = std::vector<Step>;

/// The way through all surfaces in their order, by which light makes the image.
[[nodiscard]] Route direct_route(std::size_t surfaces);

/// The way of light that one surface reflects back and one before it forwards again.
struct Ghost {
  std::size_t first;   ///< The surface of the first reflection,
  std::size_t second;  ///< and that of the second, nearer to the object.
  double reflectance;  ///< Product of both along the normal, mean over the wavelengths.
};
[[nodiscard]] Route route_of(const Ghost& ghost, std::size_t surfaces);

/// All ghosts of two reflections, of surfaces at which the index changes or that are coated, at wavelengths
/// between the ends of the range.
[[nodiscard]] std::vector<Ghost> ghosts(const System& system, double low_nm, double high_nm);

/// Where light of a point on the object's axis goes by way of a ghost, paraxially.
struct GhostFocus {
  double image_distance_mm;  ///< Behind the last vertex; infinite where it leaves parallel.
  double diameter_mm;  ///< In the plane of the image, of what the stop and clear apertures let pass wherever
                       ///< the ghost meets them; infinite where none of them ends it.
};
/// By a y-nu trace in which a reflection turns the sign of the index. [Welford1986]
[[nodiscard]] GhostFocus ghost_focus(const SystemAt& at, const Ghost& ghost, double stop_radius_mm);

}  // namespace abbe::lens
