#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <ImathMatrix.h>

#include "importers/pbrt/parameters.h"
#include "importers/shared/spectra.h"

namespace abbe::importers::pbrt {

/// A directive with its type, such as "diffuse", and its parameters.
struct Directive {
  std::string type;
  Parameters parameters{};
  SourcePosition where{};
};

/// Value type of a texture: a "float" or a "spectrum". Two textures of different types may have the same
/// name.
enum class TextureKind { number, spectrum };

/// State of an import: the textures, materials and media that directives have named so far.
struct ImportState {
  SceneImporter& importer;
  std::filesystem::path folder;  ///< Folder of the scene file, to which its file names are relative.
  std::map<TextureKind, std::map<std::string, TextureValue>> textures{};
  std::map<std::string, Directive> materials{};
  std::map<std::string, Directive> media{};
  Imath::M44d world_mirror{};  ///< Follows every object-to-world matrix; see `world_mirror_of`.
};

/// The value called `name`. Reports an unknown name at `where` with the nearest known one, and returns
/// nullptr. `what` is the noun for the values in the message, such as "material".
template <typename Value>
[[nodiscard]] const Value* find(const std::map<std::string, Value>& values, std::string_view what,
                                const std::string& name, const SourcePosition& where,
                                SceneImporter& importer) {
  const auto found = values.find(name);
  if (found != values.end()) return &found->second;
  std::vector<std::string> names;
  for (const auto& [name_of_value, value] : values) names.push_back(name_of_value);
  importer.diagnostics.error(where, unknown_name(what, name, names));
  return nullptr;
}

}  // namespace abbe::importers::pbrt
