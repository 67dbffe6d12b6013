#pragma once

#include <optional>

#include "description/load_context.h"
#include "io/schema/fields.h"
#include "lens/iris.h"

namespace abbe::spec {

/// The blades of an aperture stop; without them the stop is round.
struct Iris {
  std::optional<int> blades;
  std::optional<schema::Located<double>> blade_rotation_deg;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Iris>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the polygonal opening of the blades; nothing if the stop is round. Warns of a rotation without
/// blades.
[[nodiscard]] std::optional<lens::Iris> build(const spec::Iris& iris, const LoadContext& context);

}  // namespace abbe::description
