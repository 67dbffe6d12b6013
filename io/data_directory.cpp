#include "io/data_directory.h"

#include <algorithm>
#include <cstdlib>

#include "io/diagnostics.h"
#include "io/error.h"
#include "io/text.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

fs::path& chosen_folder() {
  static fs::path folder;
  return folder;
}

fs::path require_folder(const fs::path& folder, const std::string& chooser) {
  std::error_code ignored;
  if (fs::is_directory(folder, ignored)) return folder;
  throw Error(ErrorCode::input, chooser, "no such folder (got " + folder.string() + ")");
}

fs::path locate() {
  if (const char* chosen = std::getenv("ABBE_DATA")) return require_folder(chosen, "ABBE_DATA");
  if (!chosen_folder().empty()) return require_folder(chosen_folder(), "set_data_directory");
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share/abbe/data";
  fs::path folder = fs::canonical(installed, error);
  if (!error && fs::is_directory(folder, error)) return folder;
  throw Error(ErrorCode::input, installed.string(), "the tables are missing; set ABBE_DATA to their folder");
}

// Paths of all tables (.csv) relative to the folder, sorted, without files of the example scenes.
std::vector<std::string> tables_of(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    std::string name = entry.path().lexically_relative(folder).generic_string();
    if (entry.is_regular_file() && name.ends_with(".csv") && !name.starts_with("scenes/"))
      names.push_back(std::move(name));
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string hash_tables(const fs::path& folder) {
  std::string lines;
  try {
    for (const std::string& name : tables_of(folder)) {
      Diagnostics diagnostics;
      const auto table = read_text(folder / name, diagnostics);
      if (!table) throw Error(ErrorCode::input, "", diagnostics.text());
      lines += sha256(table->text) + "  " + name + '\n';
    }
  } catch (const fs::filesystem_error& error) {
    throw Error(ErrorCode::input, folder.string(), error.code().message());
  }
  return sha256(lines);
}

}  // namespace

const fs::path& data_directory() {
  static const fs::path directory = locate();
  return directory;
}

void set_data_directory(const fs::path& folder) {
  chosen_folder() = folder;
}

std::vector<fs::path> data_tables() {
  std::vector<fs::path> tables;
  try {
    for (const std::string& name : tables_of(data_directory())) tables.push_back(data_directory() / name);
  } catch (const Error&) {
  } catch (const fs::filesystem_error&) {
  }
  return tables;
}

const std::string& data_sha256() {
  static const std::string hash = hash_tables(data_directory());
  return hash;
}

}  // namespace abbe
