#pragma once

#include <optional>
#include <string_view>

#include "description/importers/mitsuba/object.h"
#include "description/importers/shared/spectra.h"

namespace abbe::importers::mitsuba {

/// Direction of v in texture coordinates. In Mitsuba, v points down, along image rows. `up`: meshes whose v
/// Mitsuba flips when it reads them; Abbe does not.
enum class VDirection { down, up };

/// The spectrum of an element such as <rgb>. Nothing after an error.
[[nodiscard]] std::optional<Spectrum> spectrum_of(const Element& element, const ImportState& state);
/// The spectrum of a property, or `fallback` if absent.
[[nodiscard]] Spectrum spectrum(const Object& object, std::string_view name, const Spectrum& fallback,
                                const ImportState& state);
/// The spectrum or image of a property, or `fallback` if absent.
[[nodiscard]] TextureValue texture(const Object& object, std::string_view name, const Spectrum& fallback,
                                   VDirection v, const ImportState& state);
[[nodiscard]] spec::Reflectance reflectance(const Object& object, std::string_view name, double fallback,
                                            VDirection v, const ImportState& state);
/// The number of a property. A spectrum is reduced by `number_of`, a texture to a constant, which is noted.
/// `fallback` if there is none.
[[nodiscard]] double number(const Object& object, std::string_view name, double fallback,
                            const ImportState& state);
/// The image of a bitmap texture. Nothing, after an error or a note, for other textures.
[[nodiscard]] std::optional<spec::TextureFile> image(const Object& texture, VDirection v,
                                                     const ImportState& state);

/// The emission spectrum of a property:
/// - samples and temperatures are absolute, in W and nm;
/// - a colour or number c is D65, scaled so that its integral times the CIE 1931 y equals that of the
///   constant spectrum c;
/// - a spectrum of type "uniform" is constant.
[[nodiscard]] ImportedLightSpectrum light_spectrum(const Object& object, std::string_view name,
                                                   const ImportState& state);
/// Integral of the CIE 1931 y from 360 to 830 nm [nm].
[[nodiscard]] double y_integral();

}  // namespace abbe::importers::mitsuba
