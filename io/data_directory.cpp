#include "io/data_directory.h"

#include <cstdlib>

#include "io/error.h"

namespace abbe {
namespace {

std::filesystem::path locate() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (const char* chosen = std::getenv("ABBE_DATA")) {
    if (fs::is_directory(chosen, ignored)) return chosen;
    throw Error(ErrorCode::input, "ABBE_DATA", std::string("no such folder (got ") + chosen + ")");
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  fs::path installed = program.parent_path().parent_path() / "share/abbe/data";
  if (fs::is_directory(installed, ignored)) return installed;
  if (fs::is_directory(ABBE_SOURCE_DATA, ignored)) return ABBE_SOURCE_DATA;
  throw Error(ErrorCode::input, installed.string(), "the tables are missing; set ABBE_DATA to their folder");
}

}  // namespace

const std::filesystem::path& data_directory() {
  static const std::filesystem::path directory = locate();
  return directory;
}

}  // namespace abbe
