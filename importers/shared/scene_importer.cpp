#include "importers/shared/scene_importer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "io/json.h"
#include "io/text.h"
#include "sampling/angle.h"

namespace abbe::importers {

namespace fs = std::filesystem;

namespace {

// `name`, or "`name` 2", "`name` 3" and so on if a material has that name.
std::string unused_material_name(const std::string& name, const spec::Scene& scene) {
  bool taken = false;
  std::vector<bool> numbers(scene.materials.size() + 3, false);  // Used numbers; at least one is unused.
  for (const auto& material : scene.materials) {
    const std::string_view other = material.name;
    if (!other.starts_with(name)) continue;
    const std::string_view suffix = other.substr(name.size());
    taken = taken || suffix.empty();
    std::size_t number = 0;
    if (suffix.size() < 2 || suffix[0] != ' ' || suffix[1] == '0') continue;
    const auto read = std::from_chars(suffix.data() + 1, suffix.data() + suffix.size(), number);
    if (read.ec == std::errc() && read.ptr == suffix.data() + suffix.size() && number < numbers.size())
      numbers[number] = true;
  }
  if (!taken) return name;
  return fmt::format("{} {}", name, std::find(numbers.begin() + 2, numbers.end(), false) - numbers.begin());
}

// Mean of the cosine over the falloff. The intensity is I w(a), with w = 1 up to a0 and 0 from a1 on. Its
// flux is
//
//   2 pi I int w sin a da = 2 pi I (1 - c),  c = int cos a (-dw).
//
// A hard edge at the cosine c has that flux.
double mean_cosine(double a0, double a1, Falloff falloff) {
  const double c0 = std::cos(a0);
  const double c1 = std::cos(a1);
  if (falloff == Falloff::linear_angle) return (std::sin(a1) - std::sin(a0)) / (a1 - a0);
  if (falloff == Falloff::squared_cosine) return (2 * c0 + c1) / 3;
  return (c0 + c1) / 2;
}

}  // namespace

void SceneImporter::note(const SourcePosition& where, const std::string& text) {
  const auto known = std::ranges::find(notes, text, &Note::text);
  if (known != notes.end()) {
    ++known->count;
    return;
  }
  reserve_memory(2 * (sizeof(Note) + text.size()));  // The factor 2 is for the warning.
  notes.push_back({where, text});
}

bool SceneImporter::refuse(const SourcePosition& where, std::string what) {
  diagnostics.error(where, std::move(what));
  return false;
}

std::nullopt_t SceneImporter::fail(const SourcePosition& where, std::string what, ErrorCode code) {
  diagnostics.error(where, std::move(what), code);
  return std::nullopt;
}

bool SceneImporter::is_known(std::string_view what, const std::string& name,
                             const std::vector<std::string>& names, const SourcePosition& where) {
  return std::ranges::find(names, name) != names.end() || refuse(where, unknown_name(what, name, names));
}

void SceneImporter::limit_depth(int depth, const SourcePosition& where) {
  if (depth < 1) note(where, "a maximum depth below 1 is not supported: 1 is used");
  scene.render->max_depth = std::max(1, depth);
}

void SceneImporter::note_medium(const SourcePosition& where) {
  if (surface_integrator.empty()) return;
  note(where, fmt::format("the integrator \"{}\" ignores media: Abbe scatters and absorbs light in them",
                          surface_integrator));
}

void SceneImporter::reserve_memory(std::size_t bytes) const {
  if (inputs != nullptr) inputs->reserve_memory(file, bytes);
}

std::shared_ptr<const SourceText> SceneImporter::read(const fs::path& path) const {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (inputs != nullptr && !error)
    inputs->reserve_memory(path.string(), std::min<std::uintmax_t>(size, kMaxTextBytes));
  auto source = read_text(path, diagnostics);
  if (source && inputs != nullptr) inputs->add_file(path);
  return source;
}

void SceneImporter::reserve_values(std::size_t count, std::size_t bytes_of_texts) {
  reserve_memory(count * 2 * sizeof(double) +
                 // The factor 2 is for the spare capacity of growing lists.
                 bytes_of_texts);
  values += count;
  text_bytes += bytes_of_texts;
}

std::size_t SceneImporter::bytes_to_write() const {
  constexpr std::size_t kTextOfValue = 25;  // Digits of a number and its separator.
  const std::size_t written = values * kTextOfValue + text_bytes;
  return values * 2 * sizeof(JsonValue) + text_bytes + 2 * written;
}

std::string SceneImporter::name_of(const fs::path& file) const {
  const fs::path relative = fs::absolute(file).lexically_normal().lexically_proximate(
      fs::absolute(folder.empty() ? "." : folder).lexically_normal());
  return file.is_absolute() && *relative.begin() == ".." ? file.string() : relative.string();
}

bool SceneImporter::check_file(const fs::path& file, const SourcePosition& where) {
  if (!is_file(file, where, diagnostics)) return false;
  if (inputs != nullptr) inputs->add_file(file);
  return true;
}

bool SceneImporter::count_include(const SourcePosition& where) {
  constexpr std::size_t kMaxIncluded = 10000;
  if (++included <= kMaxIncluded) return true;
  diagnostics.error(where, fmt::format("more than {} files are included", kMaxIncluded), ErrorCode::resource);
  return false;
}

std::string SceneImporter::add_material(const std::string& name, spec::Material material) {
  std::string free = unused_material_name(name, scene);
  reserve_values(kValuesPerItem, free.size());
  scene.materials.push_back({free, std::move(material), {}});
  return free;
}

double hard_cone(double inner_deg, double outer_deg, Falloff falloff, const SourcePosition& where,
                 SceneImporter& importer) {
  if (inner_deg >= outer_deg) return outer_deg;
  importer.note(where, "the soft edge of a spot is replaced by a hard edge of equal flux");
  const double mean = mean_cosine(inner_deg * kDegree, outer_deg * kDegree, falloff);
  return std::acos(std::clamp(mean, -1.0, 1.0)) / kDegree;
}

}  // namespace abbe::importers
