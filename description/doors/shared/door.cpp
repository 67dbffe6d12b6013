#include "description/doors/shared/door.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "io/json.h"
#include "io/text.h"

namespace abbe::doors {

namespace fs = std::filesystem;

void Door::note(const SourcePosition& where, const std::string& text) {
  const auto known = std::ranges::find(notes, text, &Note::text);
  if (known != notes.end()) {
    ++known->count;
    return;
  }
  take_memory(2 * (sizeof(Note) + text.size()));  // as a warning too
  notes.push_back({where, text});
}

bool Door::refuse(const SourcePosition& where, std::string what) {
  diagnostics.error(where, std::move(what));
  return false;
}

void Door::limit_depth(int events, const SourcePosition& where) {
  if (events < 1) note(where, "a path has one scattering or more here");
  scene.render->max_depth = std::max(1, events);
}

void Door::note_medium(const SourcePosition& where) {
  if (surface_integrator.empty()) return;
  note(where,
       fmt::format("the integrator \"{}\" leaves media out there: here light is scattered and absorbed in "
                   "them",
                   surface_integrator));
}

void Door::take_memory(std::size_t bytes) const {
  if (inputs != nullptr) inputs->take_memory(file, bytes);
}

std::shared_ptr<const SourceText> Door::read(const fs::path& path) const {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (inputs != nullptr && !error)
    inputs->take_memory(path.string(), std::min<std::uintmax_t>(size, kMaxTextBytes));
  auto source = read_text(path, diagnostics);
  if (source && inputs != nullptr) inputs->add_file(path);
  return source;
}

void Door::add_values(std::size_t count, std::size_t bytes_of_texts) {
  take_memory(count * 2 * sizeof(double) + bytes_of_texts);  // lists have up to twice the room that they need
  values += count;
  text_bytes += bytes_of_texts;
}

std::size_t Door::bytes_to_write() const {
  constexpr std::size_t kTextOfValue = 25;  // the digits of a number and its separator
  const std::size_t written = values * kTextOfValue + text_bytes;
  return values * 2 * sizeof(JsonValue) + text_bytes + 2 * written;
}

std::string Door::name_of(const fs::path& file) const {
  const fs::path beside = fs::absolute(file).lexically_normal().lexically_proximate(
      fs::absolute(folder.empty() ? "." : folder).lexically_normal());
  return file.is_absolute() && *beside.begin() == ".." ? file.string() : beside.string();
}

bool Door::take_file(const fs::path& file, const SourcePosition& where) {
  if (!is_file(file, where, diagnostics)) return false;
  if (inputs != nullptr) inputs->add_file(file);
  return true;
}

bool Door::take_included(const SourcePosition& where) {
  constexpr std::size_t kMaxIncluded = 10000;
  if (++included <= kMaxIncluded) return true;
  diagnostics.error(where, fmt::format("more than {} files are included", kMaxIncluded), ErrorCode::resource);
  return false;
}

std::string Door::free_material_name(const std::string& name) const {
  bool taken = false;
  std::vector<bool> numbers(scene.materials.size() + 3, false);  // behind the name, one of them free
  for (const auto& material : scene.materials) {
    const std::string_view other = material.name;
    if (!other.starts_with(name)) continue;
    const std::string_view behind = other.substr(name.size());
    taken = taken || behind.empty();
    std::size_t number = 0;
    if (behind.size() < 2 || behind[0] != ' ' || behind[1] == '0') continue;
    const auto read = std::from_chars(behind.data() + 1, behind.data() + behind.size(), number);
    if (read.ec == std::errc() && read.ptr == behind.data() + behind.size() && number < numbers.size())
      numbers[number] = true;
  }
  if (!taken) return name;
  return fmt::format("{} {}", name, std::find(numbers.begin() + 2, numbers.end(), false) - numbers.begin());
}

std::string Door::add_material(const std::string& name, spec::Material material) {
  std::string free = free_material_name(name);
  add_values(kValuesOfOne, free.size());
  scene.materials.push_back({free, std::move(material), {}});
  return free;
}

}  // namespace abbe::doors
