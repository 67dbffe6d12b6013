#pragma once

#include "description/load_context.h"
#include "description/material.h"
#include "scene/scene.h"

namespace abbe::description {

// Checks of a scene that has been built. Errors and warnings go to `context.diagnostics`.

/// Smallest wavelength range [nm] outside which all curves passed to `extend` are zero; empty at first.
struct Support {
  double low = kMaxWavelengthNm;
  double high = kMinWavelengthNm;
};
/// Enlarges the range so that it contains all wavelengths at which `curve` is not zero.
void extend(Support& support, const Curve& curve);

/// Warns of every light that emits nothing, or nothing that a channel of the sensor records; an error if the
/// diagnostics are strict. Lights must be in the order of `context.emission_positions`.
void check_lights(const LoadContext& context, const Scene& scene);

/// Reports as errors geometry that single precision cannot resolve. The scene must have been recentred. A
/// float step is the spacing of floats at the largest coordinate of a shape's box:
/// - a shape with a medium inside, or an emitting mesh, whose box has a diagonal of fewer than 64 steps;
/// - any other shape of fewer than 8 steps, unless it is far from the camera;
/// - a pixel, or a distant scene, that spans too few distinguishable directions. This error is at `camera`.
void check_precision(const SourcePosition& camera, const LoadContext& context, const Scene& scene);
/// Warns at `where` if the data of n, or a measured k, do not cover the part `sensor` [nm] in which the
/// sensor responds.
void check_validity(const IndexUse& use, const Support& sensor, const SourcePosition& where,
                    Diagnostics& diagnostics);
/// Warns of every refractive index of a material of `scene` that is used outside the wavelengths of its data.
/// Reports as an error a medium that must be clear and absorbs where the sensor responds
/// (`transparency_fault`). `materials` gives the positions of the messages.
void check_validity(const spec::Materials& materials, const LoadContext& context, const Scene& scene);

}  // namespace abbe::description
