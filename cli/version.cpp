#include "cli/version.h"

#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "io/data_directory.h"

namespace abbe::cli {
namespace {

#ifdef __clang__
constexpr std::string_view kCompiler = "Clang " __clang_version__;
#else
constexpr std::string_view kCompiler = "GCC " __VERSION__;
#endif

// Versions from the build, since this module does not include the headers of the libraries.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kLibraries{{
    {"Embree", ABBE_EMBREE_VERSION},
    {"OpenEXR", ABBE_OPENEXR_VERSION},
    {"OpenImageIO", ABBE_OPENIMAGEIO_VERSION},
    {"OpenColorIO", ABBE_OPENCOLORIO_VERSION},
    {"Ceres", ABBE_CERES_VERSION},
}};

}  // namespace

std::string version_text() {
  std::string lines = fmt::format("abbe {}\ndata {}\ndata_sha256 {}\ncompiler {}\n", ABBE_VERSION,
                                  data_directory().string(), data_sha256(), kCompiler);
  for (const auto& [name, version] : kLibraries) lines += fmt::format("{} {}\n", name, version);
  lines.pop_back();  // CLI11 ends the line
  return lines;
}

}  // namespace abbe::cli
