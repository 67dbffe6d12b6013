#pragma once

#include <filesystem>

#include "description/doors/shared/door.h"

namespace abbe::doors {

/// Reads a scene file of Mitsuba, version 3, into the scene of the door. Reports what is malformed, unknown
/// or missing; notes what is approximated or dropped. False if there is an error.
bool read_mitsuba(const std::filesystem::path& file, Door& door);

}  // namespace abbe::doors
