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

// Errors go to `state.importer.diagnostics`; approximations and losses go to `SceneImporter::note`. Functions
// throw Error{resource} if the memory limit of `state.importer.inputs` is exceeded.

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

/// The value of a Texture directive of the type `kind`. Textures become a constant or an image. A type of
/// texture without a counterpart is noted and becomes a constant.
[[nodiscard]] TextureValue texture_of(const Directive& directive, TextureKind kind, ImportState& state);
/// The spectrum of the parameter called `name`; `fallback` if it is absent, and after an error such as an
/// unknown name of a spectrum. Samples and files are 0 outside their wavelengths [nm].
[[nodiscard]] Spectrum spectrum(const Parameters& parameters, std::string_view name, const Spectrum& fallback,
                                ImportState& state);
/// The spectrum of the parameter called `name`, or the texture of the type `kind` that it names; `fallback`
/// if it is absent, and after an error.
[[nodiscard]] TextureValue texture(const Parameters& parameters, std::string_view name,
                                   const Spectrum& fallback, TextureKind kind, ImportState& state);
/// The reflectance of the parameter called `name`: an image, or a spectrum converted to a curve by
/// `curve_of`. `fallback` if it is absent, and after an error.
[[nodiscard]] spec::Reflectance reflectance(const Parameters& parameters, std::string_view name,
                                            double fallback, ImportState& state);
/// The number of the parameter called `name`, or of the constant texture that it names; spectra are reduced
/// by `number_of`. `fallback` if it is absent, after an error, and for an image, which is noted.
[[nodiscard]] double number(const Parameters& parameters, std::string_view name, double fallback,
                            ImportState& state);
/// The image of the float texture called `texture`. Nothing, after an error or a note, if it is not an image.
[[nodiscard]] std::optional<spec::TextureFile> image(const std::string& texture, const SourcePosition& where,
                                                     ImportState& state);
/// The image file of an "imagemap" texture with the mapping that its parameters declare. Reports a missing
/// parameter "filename" at `where`, and a missing file. Nothing after an error.
[[nodiscard]] std::optional<spec::TextureFile> image_file(const Parameters& parameters,
                                                          const SourcePosition& where, ImportState& state);

/// The complex index of a metal. `eta` and `k` are the names of the parameters for its real and imaginary
/// part; absent parameters are those of copper. A spectrum with an error counts as 1.
[[nodiscard]] spec::Ior metal_index(const Parameters& parameters, std::string_view eta, std::string_view k,
                                    ImportState& state);
/// The real index of a dielectric from the parameter that `eta` names: a number, a colour or samples, such as
/// a named glass; 1.5 if it is absent, and after an error. pbrt's glasses have no absorption.
[[nodiscard]] spec::Ior glass_index(const Parameters& parameters, std::string_view eta, ImportState& state);

}  // namespace abbe::importers::pbrt
