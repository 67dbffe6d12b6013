#include "importers/pbrt/transforms.h"

#include <array>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "importers/shared/placement.h"
#include "io/text.h"

namespace abbe::importers::pbrt {
namespace {

using Imath::M44d;
using Imath::V3d;

// The matrix of a transform directive, or an error.
struct Step {
  std::optional<M44d> matrix;
  const char* fault = "";
};

// World-to-camera matrix of LookAt, for a camera with x to the right, y up and z forward.
Step look_at(const std::vector<double>& n) {
  const V3d from(n[0], n[1], n[2]);
  const V3d z = (V3d(n[3], n[4], n[5]) - from).normalized();
  const V3d right = V3d(n[6], n[7], n[8]).normalized().cross(z);
  if (z.length2() == 0 || right.length2() < 1e-24)
    return {{}, "the view direction is zero or parallel to up"};
  const V3d x = right.normalized();
  const V3d y = z.cross(x);
  return {M44d(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, from.x, from.y, from.z, 1).inverse()};
}

Step translate(const std::vector<double>& n) {
  return {translation({n[0], n[1], n[2]})};
}

Step scale(const std::vector<double>& n) {
  if (n[0] * n[1] * n[2] == 0) return {{}, "a scale factor must not be 0"};
  return {scaling({n[0], n[1], n[2]})};
}

Step rotate(const std::vector<double>& n) {
  const V3d axis(n[1], n[2], n[3]);
  if (axis.length2() == 0) return {{}, "the axis of a rotation must not be 0"};
  return {rotation(axis, n[0])};
}

// The file has matrices column by column, which for row vectors is row by row.
Step matrix(const std::vector<double>& n) {
  const M44d by = from_rows(n).transposed();
  if (by.determinant() == 0) return {{}, "a matrix is singular"};
  return {by};
}

Step identity(const std::vector<double>& /*n*/) {
  return {M44d()};
}

struct TransformDirective {
  std::string_view word;
  std::size_t count;
  Step (*step)(const std::vector<double>& numbers);
  bool replaces;  // True if it replaces the current transform.
};
constexpr std::array<TransformDirective, 7> kTransformDirectives{{{"Identity", 0, identity, true},
                                                                  {"LookAt", 9, look_at, false},
                                                                  {"Translate", 3, translate, false},
                                                                  {"Scale", 3, scale, false},
                                                                  {"Rotate", 4, rotate, false},
                                                                  {"Transform", 16, matrix, true},
                                                                  {"ConcatTransform", 16, matrix, false}}};

}  // namespace

bool read_numbers(std::size_t count, const Token& word, Tokens& tokens, std::vector<double>& to,
                  SceneImporter& importer) {
  const bool bracketed = count > 0 && tokens.peek() && tokens.peek()->is("[");
  if (bracketed) (void)tokens.next();
  for (std::size_t i = 0; i < count + (bracketed ? 1 : 0); ++i) {
    const auto token = tokens.next();
    if (!token)
      return !tokens.failed() &&
             importer.refuse(tokens.end(), fmt::format("the file ends within {}", word.text));
    if (i == count)
      return token->is("]") ||
             importer.refuse(token->where, fmt::format("expected ] (got \"{}\")", token->text));
    const auto number = token->quoted ? std::nullopt : parse_number(token->text);
    if (!number)
      return importer.refuse(token->where, fmt::format("expected number {} of {} of {} (got \"{}\")", i + 1,
                                                       count, word.text, token->text));
    to.push_back(*number);
  }
  return true;
}

bool apply_transform(const Token& word, Tokens& tokens, M44d& to_world, SceneImporter& importer) {
  for (const TransformDirective& directive : kTransformDirectives) {
    if (directive.word != word.text) continue;
    std::vector<double> numbers;
    if (!read_numbers(directive.count, word, tokens, numbers, importer)) return false;
    const Step step = directive.step(numbers);
    if (!step.matrix) return importer.refuse(word.where, step.fault);
    to_world = directive.replaces ? *step.matrix : *step.matrix * to_world;
    return true;
  }
  throw Error(ErrorCode::internal, "pbrt", "not a transform directive: " + word.text);
}

}  // namespace abbe::importers::pbrt
