#include "description/transform.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "description/value_ranges.h"

namespace abbe {

static constexpr double kMaxScale = 1e9;

namespace spec {
namespace {

using namespace schema;

constexpr Range kScale{0, kMaxScale, true, false};
constexpr Range kSignedScale{-kMaxScale, kMaxScale};

Field scale(std::optional<double> Similarity::*member) {
  return field("scale", member, kScale, "Factor for all lengths.");
}
Field scale(std::optional<std::variant<double, Imath::V3d>> GeneralStep::*member) {
  return field("scale", member,
               forms<std::variant<double, Imath::V3d>>("", "a scale: a factor or three",
                                                       form<Imath::V3d>(Json::list, kSignedScale),
                                                       form<double>(Json::number, kScale)),
               "Factor for all lengths, or factors along x, y and z; negative ones mirror.");
}

}  // namespace

Fields fields(Tag<Rotation>) {
  return describe("rotation", "A right-handed rotation about an axis through the origin.",
                  {field("axis", &Rotation::axis, direction(), "Direction of the axis."),
                   field("deg", &Rotation::deg, kAngle, "Angle.")});
}

template <typename Scale>
Fields fields(Tag<Step<Scale>>) {
  using S = Step<Scale>;
  const std::string_view name = std::is_same_v<S, Similarity> ? "similarity" : "stretch";
  return describe(name, "A step that scales, then rotates, then translates.",
                  {scale(&S::scale), field("rotate", &S::rotate, "Rotation after the scale."),
                   field("translate", &S::translate, kCoordinate, "Displacement after scale and rotation.")});
}

static Fields fields(Tag<Matrix>) {
  return describe("matrix", "A step given as a matrix.",
                  {field("matrix", &Matrix::rows, kCoordinate.in(""),
                         "Rows of a matrix for column vectors: 12 numbers, or 16 of which the last are 0 0 0 "
                         "1. The fourth column translates.")});
}

ValueType similarity_steps() {
  return list<Similarity>("steps", 0, true);
}

ValueType affine_steps() {
  return list<Affine>(forms<Affine>("", "a step of a transform", form<Matrix>(Json::object, {"matrix"}),
                                    form<GeneralStep>(Json::object)),
                      "steps", 0, true);
}

}  // namespace spec

namespace description {
namespace {

// Generous bound of the relative error of a determinant in double precision.
constexpr double kDeterminantRounding = 1e-13;

// Appends rotation, then translation, which follow the scale of a step.
void append_motion(Imath::M44d& matrix, const std::optional<spec::Rotation>& rotate,
                   const std::optional<Imath::V3d>& translate, const LoadContext& context) {
  if (rotate)
    matrix =
        matrix * Imath::M44d().setAxisAngle(rotate->axis.normalized(), rotate->deg * std::numbers::pi / 180);
  if (translate) matrix = matrix * Imath::M44d().setTranslation(*translate * context.unit_m);
}

bool append(Imath::M44d& matrix, const spec::GeneralStep& step, const LoadContext& context) {
  if (step.scale)
    matrix = matrix * std::visit([](const auto& by) { return Imath::M44d().setScale(by); }, *step.scale);
  append_motion(matrix, step.rotate, step.translate, context);
  return true;
}

// Appends a matrix for column vectors, given by rows. The fourth column translates; a fourth row must be 0 0
// 0 1. False after an error.
bool append(Imath::M44d& matrix, const spec::Matrix& step, const LoadContext& context) {
  const std::vector<double>& m = step.rows.value;
  const bool rows4 = m.size() == 16;
  if (!rows4 && m.size() != 12) {
    context.diagnostics.error(
        step.rows.where,
        fmt::format("expected the rows of a matrix (got {} numbers, allowed 12 or 16)", m.size()));
    return false;
  }
  if (rows4 && !(m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1)) {
    context.diagnostics.error(
        step.rows.where,
        fmt::format("a transform must be affine (got the last row [{}, {}, {}, {}], allowed [0, 0, 0, 1])",
                    m[12], m[13], m[14], m[15]));
    return false;
  }
  Imath::M44d by;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      by[column][row] = m[static_cast<std::size_t>(4 * row + column)] * (column == 3 ? context.unit_m : 1);
  matrix = matrix * by;
  return true;
}

// Frobenius norm of the linear part.
double norm(const Imath::M44d& matrix) {
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum += matrix[i][j] * matrix[i][j];
  return std::sqrt(sum);
}

}  // namespace

Transform build(const std::vector<spec::Similarity>& steps, const LoadContext& context) {
  Transform transform;
  for (const spec::Similarity& step : steps) {
    if (step.scale) {
      transform.matrix = transform.matrix * Imath::M44d().setScale(*step.scale);
      transform.scale *= *step.scale;
    }
    append_motion(transform.matrix, step.rotate, step.translate, context);
  }
  return transform;
}

std::optional<Imath::M44d> build(const std::vector<spec::Affine>& steps, const SourcePosition& where,
                                 const LoadContext& context) {
  Imath::M44d matrix;
  for (const spec::Affine& step : steps)
    if (!std::visit([&](const auto& by) { return append(matrix, by, context); }, step)) return std::nullopt;
  const Imath::V3d rows[3] = {{matrix[0][0], matrix[0][1], matrix[0][2]},
                              {matrix[1][0], matrix[1][1], matrix[1][2]},
                              {matrix[2][0], matrix[2][1], matrix[2][2]}};
  const double determinant = rows[0].dot(rows[1].cross(rows[2]));
  const double largest = rows[0].length() * rows[1].length() * rows[2].length();
  if (!(std::abs(determinant) > kDeterminantRounding * largest) || !std::isfinite(determinant))
    return context.refuse(
        where, fmt::format("transform is singular (determinant got {:g}, allowed not 0)", determinant));
  // Embree inverts the matrix in float.
  const double shrinks = 1 / norm(matrix.inverse());
  if (norm(matrix) <= 2 * kMaxScale && shrinks >= 0.5 / kMaxScale) return matrix;
  return context.refuse(
      where, fmt::format("transform is out of range (got lengths times {:g} to {:g}, allowed [{:g}, {:g}])",
                         shrinks, norm(matrix), 1 / kMaxScale, kMaxScale));
}

}  // namespace description
}  // namespace abbe
