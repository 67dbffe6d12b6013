#pragma once

#include <optional>
#include <variant>
#include <vector>

#include <ImathMatrix.h>
#include <ImathVec.h>

#include "description/load_context.h"
#include "io/schema/fields.h"

namespace abbe::spec {

struct Rotation {
  Imath::V3d axis{0, 0, 0};
  double deg = 0;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Rotation>);
/// A step that scales, then rotates, then translates.
template <typename Scale>
struct Step {
  std::optional<Scale> scale;
  std::optional<Rotation> rotate;
  std::optional<Imath::V3d> translate;
};
using Similarity = Step<double>;                         ///< Keeps the forms of shapes.
using Stretch = Step<std::variant<double, Imath::V3d>>;  ///< Of an instance: may stretch and mirror.
/// A step given by rows.
struct Matrix {
  schema::Located<std::vector<double>> rows;
};
using Affine = std::variant<Stretch, Matrix>;
/// Steps one after the other, a single one without brackets.
[[nodiscard]] schema::Kind similarity_steps();
[[nodiscard]] schema::Kind affine_steps();

}  // namespace abbe::spec

namespace abbe::description {

/// What a `transform` does, as a matrix for row vectors [m], and the product of its uniform scales.
struct Transform {
  Imath::M44d matrix;
  double scale = 1;
};
[[nodiscard]] Transform build(const std::vector<spec::Similarity>& steps, const LoadContext& context);
/// The affine map of all steps; rows that are no matrix and a map without an inverse are reported at `where`.
[[nodiscard]] std::optional<Imath::M44d> build(const std::vector<spec::Affine>& steps,
                                               const SourcePosition& where, const LoadContext& context);

}  // namespace abbe::description
