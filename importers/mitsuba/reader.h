#pragma once

#include <filesystem>

#include "importers/shared/scene_importer.h"

namespace abbe::importers {

/// Reads a scene file of Mitsuba 3 into `importer.scene`; its unit of length counts as a metre. Reports
/// malformed, unknown and missing data to `importer.diagnostics`; notes what is approximated or dropped.
/// False if the diagnostics have an error. Throws Error{resource} if the memory limit of `importer.inputs` is
/// exceeded.
bool read_mitsuba(const std::filesystem::path& file, SceneImporter& importer);

}  // namespace abbe::importers
