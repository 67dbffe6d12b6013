#pragma once

#include <optional>
#include <variant>

#include <ImathVec.h>

namespace abbe {

/// The electric field oscillates along a unit axis of the scene, projected perpendicular to the propagation
/// direction.
struct LinearPolarisation {
  Imath::V3f axis{0, 0, 1};
};
/// The electric field rotates: clockwise as seen by the receiver, who looks towards the source, if
/// right-handed, otherwise counter-clockwise.
struct CircularPolarisation {
  bool right = true;
};

/// Polarisation of all light that a light emits.
struct LightPolarisation {
  float degree = 1;  ///< Degree of polarisation, in [0, 1].
  std::variant<LinearPolarisation, CircularPolarisation> kind;
};

/// Normalised Stokes vector (1, q, u, v), in the frame whose first axis is the unit vector `axis`,
/// perpendicular to the propagation direction. q is 1 for full linear polarisation along `axis`, and v is 1
/// for full right-handed circular polarisation. `docs/physics/conventions.md` defines the signs.
struct PolarisationState {
  Imath::V3f axis;
  float q = 0;
  float u = 0;
  float v = 0;
};

/// Polarisation state of light that propagates along the unit direction `travels`. Nothing if it is linear
/// and its axis is parallel to that direction, where the state is undefined.
[[nodiscard]] std::optional<PolarisationState> polarised(const LightPolarisation& of,
                                                         const Imath::V3f& travels);

}  // namespace abbe
