#pragma once

#include "description/load_context.h"
#include "description/material.h"
#include "scene/scene.h"

namespace abbe::description {

/// Where curves differ from zero: from `low` to `high` nm, which are in the other order where none does.
struct Support {
  double low = kMaxWavelengthNm;
  double high = kMinWavelengthNm;
};
/// Takes in where this curve does.
void extend(Support& support, const Curve& curve);

/// Warns of every lamp that emits nothing the sensor sees.
void check_lamps(const LoadContext& context, const Scene& scene);

/// Reports what floats cannot tell apart, once the scene is recentred: a shape with matter inside, or a mesh
/// that emits, only few float steps large where it stands, and a view of little more than one direction, of
/// the `camera` said there.
void check_precision(const SourcePosition& camera, const LoadContext& context, const Scene& scene);
/// Warns at `where` if this index does not hold for all wavelengths that the sensor sees, and if its k, where
/// it has one, is not measured for all of these that n is.
void check_validity(const IndexUse& use, const Support& sensor, const SourcePosition& where,
                    Diagnostics& diagnostics);
/// Warns of every index of a material used beyond the wavelengths it holds for, and refuses what is taken as
/// clear and is not (`clear_fault`) where the sensor sees.
void check_validity(const spec::Materials& materials, const LoadContext& context, const Scene& scene);

}  // namespace abbe::description
