#pragma once

#include <optional>
#include <variant>

#include <ImathVec.h>

namespace abbe {

/// The field swings along a unit axis of the scene, as far as that lies across the way of the light.
struct LinearPolarisation {
  Imath::V3f axis{0, 0, 1};
};
/// The field turns: clockwise as the receiver sees it, which is right-handed, or the other way.
struct CircularPolarisation {
  bool right = true;
};

/// How all light of a lamp is polarised.
struct LampPolarisation {
  float degree = 1;  ///< Share of the light that is polarised, in [0, 1].
  std::variant<LinearPolarisation, CircularPolarisation> kind;
};

/// The Stokes vector (1, q, u, v) of light over its intensity, told in the frame whose first axis is this
/// unit vector, which lies across the way of the light. `docs/physics/conventions.md` says what the signs
/// mean.
struct Polarised {
  Imath::V3f axis;
  float q = 0;
  float u = 0;
  float v = 0;
};

/// The same for light that travels in that unit direction; nothing where the axis of a linear one lies along
/// it.
[[nodiscard]] std::optional<Polarised> polarised(const LampPolarisation& of, const Imath::V3f& travels);

}  // namespace abbe
