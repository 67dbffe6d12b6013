#pragma once

#include <cstddef>
#include <vector>

#include <ImathMatrix.h>

#include "importers/pbrt/tokens.h"

namespace abbe::importers::pbrt {

// Errors go to `importer.diagnostics`. Functions throw Error{resource} if the memory limit of
// `importer.inputs` is exceeded.

/// Reads `count` numbers after the directive `word`, with or without brackets, and appends them to `to`.
/// Reports other tokens and the end of the file, and returns false.
bool read_numbers(std::size_t count, const Token& word, Tokens& tokens, std::vector<double>& to,
                  SceneImporter& importer);

/// Reads the arguments of the transform directive `word` and updates `to_world`, a matrix for row vectors.
/// LookAt, Translate, Scale, Rotate and ConcatTransform apply to points before the old `to_world`; Identity
/// and Transform replace it. Angles are in degrees. Reports singular matrices, a zero axis or scale factor, a
/// view direction along up, and the errors of `read_numbers`; then returns false and leaves `to_world`
/// unchanged. Throws Error{internal} for any other directive.
bool apply_transform(const Token& word, Tokens& tokens, Imath::M44d& to_world, SceneImporter& importer);

}  // namespace abbe::importers::pbrt
