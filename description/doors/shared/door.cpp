#include "description/doors/shared/door.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe::doors {

namespace fs = std::filesystem;

void Door::note(const SourcePosition& where, const std::string& text) {
  const auto known = std::ranges::find(notes, text, &Note::text);
  if (known == notes.end())
    notes.push_back({where, text});
  else
    ++known->count;
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

std::string Door::free_material_name(const std::string& name) const {
  const auto taken = [this](const std::string& candidate) {
    return std::ranges::find(scene.materials, candidate, &schema::Named<spec::Material>::name) !=
           scene.materials.end();
  };
  std::string free = name;
  for (int i = 2; taken(free); ++i) free = fmt::format("{} {}", name, i);
  return free;
}

std::string Door::add_material(const std::string& name, spec::Material material) {
  std::string free = free_material_name(name);
  scene.materials.push_back({free, std::move(material), {}});
  return free;
}

}  // namespace abbe::doors
