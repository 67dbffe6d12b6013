#pragma once

#include <optional>

#include <ImathMatrix.h>

#include "description/load_context.h"
#include "io/object_reader.h"

namespace abbe::description {

/// What a `transform` does, as a matrix for row vectors [m], and the product of its uniform scales.
struct Transform {
  Imath::M44d matrix;
  double scale = 1;
};
/// Steps of uniform scale, rotation and translation.
[[nodiscard]] Transform read_similarity(const JsonValue& json, const LoadContext& context);
/// Reads an affine map: what `read_similarity` reads, scales along the axes, and matrices; a map without an
/// inverse is reported.
[[nodiscard]] std::optional<Imath::M44d> read_affine(const JsonValue& json, const LoadContext& context);

}  // namespace abbe::description
