#pragma once

#include "description/load_context.h"
#include "description/material.h"
#include "scene/scene.h"

namespace abbe::description {

/// Smallest wavelength range [nm] outside which all curves are zero. `low` > `high` if every curve is zero
/// everywhere.
struct Support {
  double low = kMaxWavelengthNm;
  double high = kMinWavelengthNm;
};
/// Enlarges the range so that it contains all wavelengths at which `curve` is not zero.
void extend(Support& support, const Curve& curve);

/// Warns of every light that emits nothing in the wavelength range of the sensor. The warning is an error
/// with --strict.
void check_lights(const LoadContext& context, const Scene& scene);

/// Reports geometry that single precision cannot resolve, once the scene is recentred:
/// - a shape with a medium inside, or an emitting mesh, of only a few float steps at its position;
/// - a nearby opaque shape of only a few float steps;
/// - a view that spans only a few distinguishable directions. This error is reported at `camera`.
void check_precision(const SourcePosition& camera, const LoadContext& context, const Scene& scene);
/// Warns at `where` if the data of this refractive index do not cover the wavelength range of the sensor.
/// Also warns if its k, where it has one, is measured over a shorter part of that range than its n.
void check_validity(const IndexUse& use, const Support& sensor, const SourcePosition& where,
                    Diagnostics& diagnostics);
/// Warns of every refractive index of a material that is used outside the wavelengths of its data. Reports as
/// an error a medium that must be clear and absorbs where the sensor responds (`clear_fault`).
void check_validity(const spec::Materials& materials, const LoadContext& context, const Scene& scene);

}  // namespace abbe::description
