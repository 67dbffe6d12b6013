#pragma once

#include <filesystem>

#include "io/data_directory.h"

namespace abbe::test {

/// The source tree, which holds the data: of tests that read its documents too. Said by no definition, so
/// that objects do not depend on the folder they were compiled in.
inline std::filesystem::path source_tree() {
  return std::filesystem::canonical(data_directory()).parent_path();
}

}  // namespace abbe::test
