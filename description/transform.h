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
/// A step of a transform: a scale, then a rotation, then a translation.
template <typename Scale>
struct Step {
  std::optional<Scale> scale;
  std::optional<Rotation> rotate;
  std::optional<Imath::V3d> translate;
};
/// A step that preserves angles.
using Similarity = Step<double>;
/// A step of an instance, which may scale the axes differently and mirror.
using GeneralStep = Step<std::variant<double, Imath::V3d>>;
/// A step given by the rows of a matrix.
struct Matrix {
  schema::Located<std::vector<double>> rows;
};
using Affine = std::variant<GeneralStep, Matrix>;
/// The kind of a list of steps; a single step may stand without brackets.
[[nodiscard]] schema::ValueType similarity_steps();
[[nodiscard]] schema::ValueType affine_steps();

}  // namespace abbe::spec

namespace abbe::description {

/// A transform as a matrix for row vectors [m], and the product of its uniform scales.
struct Transform {
  Imath::M44d matrix;
  double scale = 1;
};
/// Builds the product of all steps.
[[nodiscard]] Transform build(const std::vector<spec::Similarity>& steps, const LoadContext& context);
/// Builds the affine map of all steps. Reports malformed matrices, and at `where` a map that is singular or
/// out of range; returns nothing then.
[[nodiscard]] std::optional<Imath::M44d> build(const std::vector<spec::Affine>& steps,
                                               const SourcePosition& where, const LoadContext& context);

}  // namespace abbe::description
