#pragma once

#include <filesystem>

#include "description/importers/shared/scene_importer.h"

namespace abbe::importers {

/// Reads a scene file of Mitsuba 3 into the importer's scene. Reports malformed, unknown and missing data;
/// notes what is approximated or dropped. False if there is an error.
bool read_mitsuba(const std::filesystem::path& file, SceneImporter& importer);

}  // namespace abbe::importers
