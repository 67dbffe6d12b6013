#pragma once

#include <cstddef>
#include <vector>

#include <ImathMatrix.h>

#include "description/importers/pbrt/tokens.h"

namespace abbe::importers::pbrt {

/// Reads `count` numbers after a directive, with or without brackets. Reports other tokens and the end of the
/// file, and returns false.
bool read_numbers(std::size_t count, const Token& word, Tokens& tokens, std::vector<double>& to,
                  SceneImporter& importer);

/// Reads the arguments of a transform directive (Identity, LookAt, Translate, Scale, Rotate, Transform or
/// ConcatTransform) and applies it to points before `to_world`. Reports singular matrices and the errors of
/// `read_numbers`, and returns false.
bool apply_transform(const Token& word, Tokens& tokens, Imath::M44d& to_world, SceneImporter& importer);

}  // namespace abbe::importers::pbrt
