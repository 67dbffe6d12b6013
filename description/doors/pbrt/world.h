#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <ImathMatrix.h>

#include "description/doors/pbrt/parameters.h"
#include "description/doors/shared/spectra.h"

namespace abbe::doors::pbrt {

/// What a directive makes: its type, such as "diffuse", and its parameters.
struct Made {
  std::string type;
  Parameters parameters{};
  SourcePosition where{};
};

/// What a texture gives, a number or a spectrum: two of each kind may have one name.
enum class TextureKind { number, spectrum };

/// What the directives of a scene name, and where it goes.
struct World {
  Door& door;
  std::filesystem::path folder;  ///< Of the scene file: where the files it names are.
  std::map<TextureKind, std::map<std::string, TextureValue>> textures{};
  std::map<std::string, Made> materials{};
  std::map<std::string, Made> media{};
  Imath::M44d upright{};  ///< What everything goes through: see `upright_world`.
};

/// The thing of that name; an unknown one is reported with the nearest.
template <typename Thing>
[[nodiscard]] const Thing* find(const std::map<std::string, Thing>& things, std::string_view what,
                                const std::string& name, const SourcePosition& where, Door& door) {
  const auto found = things.find(name);
  if (found != things.end()) return &found->second;
  std::vector<std::string> names;
  for (const auto& [known, thing] : things) names.push_back(known);
  door.diagnostics.error(where, unknown_name(what, name, names));
  return nullptr;
}

}  // namespace abbe::doors::pbrt
