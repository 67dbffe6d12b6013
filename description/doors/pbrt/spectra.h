#pragma once

#include <optional>
#include <string>
#include <variant>

#include "description/doors/pbrt/world.h"
#include "description/doors/shared/spectra.h"

namespace abbe::doors::pbrt {

/// What a texture of a kind says; of what has no counterpart, which is noted, one value.
[[nodiscard]] TextureValue texture_of(const Made& made, TextureKind kind, World& world);
/// The spectrum of a parameter: `absent` without it and after an error, such as an unknown name.
[[nodiscard]] Spectrum spectrum(const Parameters& parameters, std::string_view name, const Spectrum& absent,
                                World& world);
/// The same of a parameter that may name a texture of that kind.
[[nodiscard]] TextureValue texture(const Parameters& parameters, std::string_view name,
                                   const Spectrum& absent, TextureKind kind, World& world);
[[nodiscard]] spec::Reflectance reflectance(const Parameters& parameters, std::string_view name,
                                            double absent, World& world);
/// A number, or what a texture says of it where it says one only.
[[nodiscard]] double number(const Parameters& parameters, std::string_view name, double absent, World& world);
/// The image of a texture; nothing, after an error or a note, where it is none.
[[nodiscard]] std::optional<spec::TextureFile> image(const std::string& texture, const SourcePosition& where,
                                                     World& world);
/// The image a file is, laid out as parameters say.
[[nodiscard]] std::optional<spec::TextureFile> image_file(const Parameters& parameters,
                                                          const SourcePosition& where, World& world);

/// The index of a metal said by `eta` and `k`; of what is absent that of copper.
[[nodiscard]] spec::Ior metal_index(const Parameters& parameters, std::string_view eta, std::string_view k,
                                    World& world);
/// The index of a dielectric said by `eta`: a number, a colour or samples, as of a named
/// glass, which absorbs nothing there.
[[nodiscard]] spec::Ior glass_index(const Parameters& parameters, std::string_view eta, World& world);

}  // namespace abbe::doors::pbrt
