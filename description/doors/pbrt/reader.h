#pragma once

#include <filesystem>

#include "description/doors/shared/door.h"

namespace abbe::doors {

/// Reads a scene file of pbrt, version 4, into the scene of the door. Reports what is malformed, unknown or
/// missing, and stops at what leaves unclear how to read on; notes what is approximated or dropped. False if
/// there is an error.
bool read_pbrt(const std::filesystem::path& file, Door& door);

}  // namespace abbe::doors
