#pragma once

#include <filesystem>

#include "description/importers/shared/scene_importer.h"

namespace abbe::importers {

/// Reads a scene file of pbrt-v4 into the importer's scene. Reports malformed, unknown and missing data;
/// stops at errors after which the syntax is ambiguous. Notes what is approximated or dropped. False if there
/// is an error.
bool read_pbrt(const std::filesystem::path& file, SceneImporter& importer);

}  // namespace abbe::importers
