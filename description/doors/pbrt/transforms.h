#pragma once

#include <cstddef>
#include <vector>

#include <ImathMatrix.h>

#include "description/doors/pbrt/tokens.h"

namespace abbe::doors::pbrt {

/// Reads so many numbers behind a directive, in brackets or without. Reports what is none, and the end of the
/// file; false then.
bool read_numbers(std::size_t count, const Token& word, Tokens& tokens, std::vector<double>& to, Door& door);

/// Reads what follows a directive of a transform (Identity, LookAt, Translate, Scale, Rotate, Transform or
/// ConcatTransform), and puts it before what `to_world` does. Reports what has no inverse, and as
/// `read_numbers` does; false then.
bool apply_transform(const Token& word, Tokens& tokens, Imath::M44d& to_world, Door& door);

}  // namespace abbe::doors::pbrt
