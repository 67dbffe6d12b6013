#include "description/load_lens.h"

#include <algorithm>
#include <system_error>

#include "description/lens.h"
#include "description/pbrt_table.h"
#include "description/zemax.h"
#include "io/data_directory.h"
#include "io/schema/read.h"
#include "io/text.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

std::optional<spec::Lens> read_json(const fs::path& file, Diagnostics& diagnostics) {
  const auto source = read_text(file, diagnostics);
  auto root = source ? parse_json(source, diagnostics) : std::nullopt;
  if (!root) return std::nullopt;
  return schema::read<spec::Lens>(*root, diagnostics);
}

using Reader = std::optional<spec::Lens> (*)(const fs::path&, Diagnostics&);

// The reader for the extension of a file; nullptr for an unknown extension.
Reader reader_of(const fs::path& file) {
  const std::string extension = extension_of(file);
  if (extension == ".json") return read_json;
  if (extension == ".zmx") return description::read_zemax;
  if (extension == ".dat") return description::read_pbrt_table;
  return nullptr;
}

}  // namespace

std::vector<std::string> lens_names() {
  std::vector<std::string> names;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(data_directory() / "lens", missing))
    if (reader_of(entry.path()) != nullptr) names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::optional<lens::System> load_lens(const std::string& name, Diagnostics& diagnostics, Inputs* inputs,
                                      const SourcePosition& where,
                                      const std::vector<double>& wavelengths_nm) {
  fs::path file = name;
  if (reader_of(file) == nullptr) {
    const std::vector<std::string> names = lens_names();
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      diagnostics.error(where, unknown_name("lens", name, names) + "; files end in .json, .zmx or .dat",
                        ErrorCode::input);
      return std::nullopt;
    }
    file = data_directory() / "lens" / (name + ".json");
  }
  const auto spec = reader_of(file)(file, diagnostics);
  if (inputs != nullptr) inputs->add_file(file);
  description::LoadContext context{diagnostics, file.parent_path(), inputs};
  auto system = spec ? description::build(*spec, context, wavelengths_nm) : std::nullopt;
  if (system && system->title.empty()) system->title = file.stem().string();
  return system;
}

}  // namespace abbe
