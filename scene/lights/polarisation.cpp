#include "scene/lights/polarisation.h"

#include "scene/lights/light.h"
#include "scene/shapes/basis.h"

namespace abbe {

std::optional<Polarised> polarised(const LampPolarisation& of, const Imath::V3f& travels) {
  if (const auto* circular = std::get_if<CircularPolarisation>(&of.kind))
    return Polarised{Basis<float>(travels).x, 0, 0, circular->right ? of.degree : -of.degree};
  constexpr float kAlong = 1e-6F;  // what of the axis is then across is rounding
  const Imath::V3f& axis = std::get<LinearPolarisation>(of.kind).axis;
  const Imath::V3f across = axis - travels * axis.dot(travels);
  if (!(across.length() > kAlong)) return std::nullopt;
  return Polarised{across.normalized(), of.degree, 0, 0};
}

std::optional<Polarised> polarisation_of(const Light& light, const Imath::V3f& travels) {
  return light.polarisation ? polarised(*light.polarisation, travels) : std::nullopt;
}

}  // namespace abbe
