#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <ImathMatrix.h>

#include "importers/pbrt/syntax.h"
#include "importers/shared/spectra.h"

namespace abbe::importers::pbrt {

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
  importer.is_known(what, name, names, where);
  return nullptr;
}

/// The value of a Texture directive: a constant or an image. A type of texture without a counterpart is noted
/// and becomes a constant.
[[nodiscard]] TextureValue texture_of(const Directive& directive, TextureKind kind, ImportState& state);

// Values of the parameter called `name`; `fallback` if it is absent, and after an error.
/// A spectrum. Samples and files are 0 outside their wavelengths [nm].
[[nodiscard]] Spectrum spectrum(const Parameters& parameters, std::string_view name, const Spectrum& fallback,
                                ImportState& state);
/// A reflectance: an image, or a spectrum converted to a curve by `curve_of`.
[[nodiscard]] spec::Reflectance reflectance(const Parameters& parameters, std::string_view name,
                                            double fallback, ImportState& state);
/// A number, or that of a constant texture; spectra are reduced by `number_of`. An image is noted and counts
/// as `fallback`.
[[nodiscard]] double number(const Parameters& parameters, std::string_view name, double fallback,
                            ImportState& state);
/// The image of the float texture called `texture`. Nothing, after an error or a note, if it is not an image.
[[nodiscard]] std::optional<spec::TextureFile> image(const std::string& texture, const SourcePosition& where,
                                                     ImportState& state);

/// The complex index of a metal. `eta` and `k` are the names of the parameters for its real and imaginary
/// part; absent parameters are those of copper. A spectrum with an error counts as 1.
[[nodiscard]] spec::Ior metal_index(const Parameters& parameters, std::string_view eta, std::string_view k,
                                    ImportState& state);
/// The real index of a dielectric from the parameter "eta"; 1.5 if it is absent, and after an error. pbrt's
/// glasses have no absorption.
[[nodiscard]] spec::Ior glass_index(const Parameters& parameters, ImportState& state);

}  // namespace abbe::importers::pbrt
