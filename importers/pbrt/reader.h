#pragma once

#include <filesystem>

#include "importers/shared/scene_importer.h"

namespace abbe::importers {

/// Reads a scene file of pbrt-v4 into `importer.scene`; its unit of length counts as a metre. Reports
/// malformed, unknown and missing data to `importer.diagnostics`; stops at errors after which the syntax is
/// ambiguous. Notes what is approximated or dropped. False if the diagnostics have an error. Throws
/// Error{resource} if the memory limit of `importer.inputs` is exceeded.
bool read_pbrt(const std::filesystem::path& file, SceneImporter& importer);

}  // namespace abbe::importers
