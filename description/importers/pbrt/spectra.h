#pragma once

#include <optional>
#include <string>
#include <variant>

#include "description/importers/pbrt/import_state.h"
#include "description/importers/shared/spectra.h"

namespace abbe::importers::pbrt {

/// The value of a texture directive. A texture without a counterpart is noted and becomes a constant.
[[nodiscard]] TextureValue texture_of(const Directive& directive, TextureKind kind, ImportState& state);
/// The spectrum of a parameter; `fallback` if absent, and after an error such as an unknown name.
[[nodiscard]] Spectrum spectrum(const Parameters& parameters, std::string_view name, const Spectrum& fallback,
                                ImportState& state);
/// The spectrum of a parameter, or the texture that it names.
[[nodiscard]] TextureValue texture(const Parameters& parameters, std::string_view name,
                                   const Spectrum& fallback, TextureKind kind, ImportState& state);
[[nodiscard]] spec::Reflectance reflectance(const Parameters& parameters, std::string_view name,
                                            double fallback, ImportState& state);
/// The number of a parameter, or of the texture that it names if that is constant; otherwise `fallback`,
/// which is noted.
[[nodiscard]] double number(const Parameters& parameters, std::string_view name, double fallback,
                            ImportState& state);
/// The image of the float texture called `texture`. Nothing, after an error or a note, if it is not an image.
[[nodiscard]] std::optional<spec::TextureFile> image(const std::string& texture, const SourcePosition& where,
                                                     ImportState& state);
/// The image file of a texture with the mapping that the parameters declare. Nothing after an error.
[[nodiscard]] std::optional<spec::TextureFile> image_file(const Parameters& parameters,
                                                          const SourcePosition& where, ImportState& state);

/// The index of a metal from the parameters named `eta` and `k`; absent ones are those of copper.
[[nodiscard]] spec::Ior metal_index(const Parameters& parameters, std::string_view eta, std::string_view k,
                                    ImportState& state);
/// The index of a dielectric from the parameter named `eta`: a number, a colour or samples, such as a named
/// glass. pbrt's glasses have no absorption.
[[nodiscard]] spec::Ior glass_index(const Parameters& parameters, std::string_view eta, ImportState& state);

}  // namespace abbe::importers::pbrt
