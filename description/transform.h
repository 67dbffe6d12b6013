#pragma once

#include <optional>
#include <variant>
#include <vector>

#include <ImathMatrix.h>
#include <ImathVec.h>

#include "description/load_context.h"
#include "io/schema/fields.h"

namespace abbe::spec {

/// A right-handed rotation about an axis through the origin.
struct Rotation {
  Imath::V3d axis{0, 0, 0};  ///< Direction of any length except 0.
  double deg = 0;            ///< Angle [degrees].
};
/// Key table by which scene files are read, written and documented.
[[nodiscard]] schema::Fields fields(schema::Tag<Rotation>);
/// A step of a transform: a scale, then a rotation, then a translation.
template <typename Scale>
struct Step {
  std::optional<Scale> scale;  ///< Factor for all lengths, or factors along x, y and z; 1 if absent.
  std::optional<Rotation> rotate;
  std::optional<Imath::V3d> translate;  ///< In scene units.
};
/// A step that preserves angles.
using Similarity = Step<double>;
/// A step of an instance, which may scale the axes differently. Negative factors along axes mirror.
using GeneralStep = Step<std::variant<double, Imath::V3d>>;
/// A step given by the rows of a matrix for column vectors in scene units: 12 numbers, or 16 with the last
/// row 0 0 0 1.
struct Matrix {
  schema::Located<std::vector<double>> rows;
};
using Affine = std::variant<GeneralStep, Matrix>;
// The forms in which scene files write a list of steps. A single step may be written without brackets.
[[nodiscard]] schema::ValueType similarity_steps();
[[nodiscard]] schema::ValueType affine_steps();

}  // namespace abbe::spec

namespace abbe::description {

/// A transform that preserves angles.
struct Transform {
  Imath::M44d matrix;  ///< Row-vector form p' = p M, with the translation [m] in the last row.
  double scale = 1;    ///< Factor for all lengths: the product of the scales of all steps.
};
/// Builds the product of all steps, of which the first is applied first; the identity without steps. Reports
/// no errors.
[[nodiscard]] Transform build(const std::vector<spec::Similarity>& steps, const LoadContext& context);
/// Builds the affine map of all steps, of which the first is applied first, as a matrix for row vectors [m].
/// Reports to `context.diagnostics`, and returns nothing for:
/// - a matrix of other than 12 or 16 numbers, or with another last row than 0 0 0 1;
/// - a map, at `where`, that is singular, or scales lengths by a factor outside about [1e-9, 1e9].
[[nodiscard]] std::optional<Imath::M44d> build(const std::vector<spec::Affine>& steps,
                                               const SourcePosition& where, const LoadContext& context);

}  // namespace abbe::description
