#include "scene/lights/polarisation.h"

#include "scene/lights/light.h"
#include "scene/shapes/ray.h"

namespace abbe {

std::optional<PolarisationState> polarised(const LightPolarisation& of, const Imath::V3f& travels) {
  if (const auto* circular = std::get_if<CircularPolarisation>(&of.kind))
    return PolarisationState{Basis<float>(travels).x, 0, 0, circular->right ? of.degree : -of.degree};
  constexpr float kAlong = 1e-6F;  // below this length, the perpendicular component of the axis is rounding
  const Imath::V3f& axis = std::get<LinearPolarisation>(of.kind).axis;
  const Imath::V3f across = axis - travels * axis.dot(travels);
  if (!(across.length() > kAlong)) return std::nullopt;
  return PolarisationState{across.normalized(), of.degree, 0, 0};
}

std::optional<PolarisationState> polarisation_of(const Light& light, const Imath::V3f& travels) {
  return light.polarisation ? polarised(*light.polarisation, travels) : std::nullopt;
}

}  // namespace abbe
