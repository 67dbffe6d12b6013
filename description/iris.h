#pragma once

#include <optional>

#include "description/load_context.h"
#include "io/schema/fields.h"
#include "lens/iris.h"

namespace abbe::spec {

/// The blades of an aperture stop; without them the stop is round.
struct Iris {
  /// Number of straight blades, from 3 to 32. The opening is the regular polygon inscribed in the circle of
  /// the stop.
  std::optional<int> blades;
  /// Clockwise rotation of the blades as the camera looks; 0, with a corner up, if absent.
  std::optional<schema::Located<double>> blade_rotation_deg;
};
/// Key table by which scene files are read, written and documented.
[[nodiscard]] schema::Fields fields(schema::Tag<Iris>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the polygonal opening of the blades; nothing if the stop is round. Warns of a rotation without
/// blades. Reports no errors.
[[nodiscard]] std::optional<lens::Iris> build(const spec::Iris& iris, const LoadContext& context);

}  // namespace abbe::description
