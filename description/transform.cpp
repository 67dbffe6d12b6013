#include "description/transform.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "description/values.h"

namespace abbe::description {
namespace {

constexpr double kMaxStretch = 1e9;
constexpr Range kScale{0, kMaxStretch, true, false};
constexpr Range kSignedScale{-kMaxStretch, kMaxStretch};

// The relative error of a determinant summed up in double, generously.
constexpr double kRounding = 1e-13;

void append(Transform& transform, const Imath::M44d& step) {
  transform.matrix = transform.matrix * step;
}

void read_scale(ObjectReader& reader, bool affine, Transform& transform, const LoadContext& context) {
  const JsonValue* json = reader.find("scale");
  if (!json) return;
  if (affine && std::holds_alternative<JsonValue::Array>(json->value)) {
    if (const auto s = read_numbers(*json, 3, kSignedScale, context.diagnostics))
      append(transform, Imath::M44d().setScale(Imath::V3d((*s)[0], (*s)[1], (*s)[2])));
  } else if (const auto factor = read_number(*json, kScale, context.diagnostics)) {
    append(transform, Imath::M44d().setScale(*factor));
    transform.scale *= *factor;
  }
}

void read_rotation(const JsonValue& json, Transform& transform, const LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const auto axis = read_direction(reader, "axis", context);
  const auto angle = reader.require_number("deg", kValue);
  reader.finish();
  if (axis && angle) append(transform, Imath::M44d().setAxisAngle(*axis, *angle * std::numbers::pi / 180));
}

// Rows of a matrix for column vectors: the fourth column translates, a fourth row must be 0 0 0 1.
void read_matrix(const JsonValue& json, Transform& transform, const LoadContext& context) {
  const auto m = read_numbers(json, 0, kCoordinate, context.diagnostics);
  if (!m) return;
  const bool rows4 = m->size() == 16;
  if (!rows4 && m->size() != 12) {
    context.diagnostics.error(
        json.where,
        fmt::format("expected the rows of a matrix (got {} numbers, allowed 12 or 16)", m->size()));
    return;
  }
  if (rows4 && !((*m)[12] == 0 && (*m)[13] == 0 && (*m)[14] == 0 && (*m)[15] == 1)) {
    context.diagnostics.error(json.where,
                              fmt::format("a transform is affine (got the last row [{}, {}, {}, {}], allowed "
                                          "[0, 0, 0, 1])",
                                          (*m)[12], (*m)[13], (*m)[14], (*m)[15]));
    return;
  }
  Imath::M44d matrix;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      matrix[column][row] =
          (*m)[static_cast<std::size_t>(4 * row + column)] * (column == 3 ? context.unit_m : 1);
  append(transform, matrix);
}

// One step; scale, then rotation, then translation, when it has several.
void read_step(const JsonValue& json, bool affine, Transform& transform, const LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  if (affine)
    if (const JsonValue* matrix = reader.find("matrix")) {
      read_matrix(*matrix, transform, context);
      reader.finish();
      return;
    }
  read_scale(reader, affine, transform, context);
  if (const JsonValue* rotation = reader.find("rotate")) read_rotation(*rotation, transform, context);
  if (reader.find("translate")) {
    const auto by = read_point(reader, "translate", context);
    if (by) append(transform, Imath::M44d().setTranslation(*by));
  }
  reader.finish();
}

Transform read_steps(const JsonValue& json, bool affine, const LoadContext& context) {
  Transform transform;
  if (const auto* steps = std::get_if<JsonValue::Array>(&json.value)) {
    for (const JsonValue& step : *steps) read_step(step, affine, transform, context);
  } else {
    read_step(json, affine, transform, context);
  }
  return transform;
}

// Root of the sum of the squares of the linear part.
double norm(const Imath::M44d& matrix) {
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum += matrix[i][j] * matrix[i][j];
  return std::sqrt(sum);
}

}  // namespace

Transform read_similarity(const JsonValue& json, const LoadContext& context) {
  return read_steps(json, false, context);
}

std::optional<Imath::M44d> read_affine(const JsonValue& json, const LoadContext& context) {
  const std::size_t faults = context.diagnostics.all().size();
  const Imath::M44d matrix = read_steps(json, true, context).matrix;
  if (context.diagnostics.all().size() > faults) return std::nullopt;
  const Imath::V3d rows[3] = {{matrix[0][0], matrix[0][1], matrix[0][2]},
                              {matrix[1][0], matrix[1][1], matrix[1][2]},
                              {matrix[2][0], matrix[2][1], matrix[2][2]}};
  const double determinant = rows[0].dot(rows[1].cross(rows[2]));
  const double largest = rows[0].length() * rows[1].length() * rows[2].length();
  if (!(std::abs(determinant) > kRounding * largest) || !std::isfinite(determinant)) {
    context.diagnostics.error(
        json.where, fmt::format("transform is singular (determinant got {:g}, allowed not 0)", determinant));
    return std::nullopt;
  }
  // Embree inverts the matrix in float.
  const double shrinks = 1 / norm(matrix.inverse());
  if (norm(matrix) <= 2 * kMaxStretch && shrinks >= 0.5 / kMaxStretch) return matrix;
  context.diagnostics.error(
      json.where,
      fmt::format("transform is out of range (got lengths times {:g} to {:g}, allowed [{:g}, {:g}])", shrinks,
                  norm(matrix), 1 / kMaxStretch, kMaxStretch));
  return std::nullopt;
}

}  // namespace abbe::description
