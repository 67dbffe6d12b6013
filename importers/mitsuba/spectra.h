#pragma once

#include <optional>
#include <string_view>

#include "importers/mitsuba/object.h"
#include "importers/shared/spectra.h"

namespace abbe::importers::mitsuba {

/// Direction in which v increases on images, for the texture coordinates that a shape has in Abbe's scene.
/// Abbe's images have v upwards, Mitsuba's downwards.
enum class VDirection {
  down,  ///< The coordinates are those of Mitsuba, so that the image mapping inverts v.
  /// The v of Abbe's shape is 1 minus Mitsuba's, so that the mapping preserves it. Such shapes are spheres,
  /// and mesh files whose v Mitsuba inverts on reading.
  up
};

/// The spectrum of an <rgb>, <spectrum>, <float>, <integer> or <texture> element. Samples are 0 outside their
/// wavelengths. A texture is noted and becomes a constant. Nothing after an error.
[[nodiscard]] std::optional<Spectrum> spectrum_of(const Element& element, const ImportState& state);

// Values of the property called `name`; `fallback` if it is absent, and after an error. `v` is that of the
// shape.
[[nodiscard]] Spectrum spectrum(const Object& object, std::string_view name, const Spectrum& fallback);
/// A spectrum or a bitmap. Other textures are noted and become a constant; an unreadable bitmap becomes 0.5.
[[nodiscard]] TextureValue texture(const Object& object, std::string_view name, const Spectrum& fallback,
                                   VDirection v);
/// A reflectance: an image, or a spectrum converted to a curve by `curve_of`.
[[nodiscard]] spec::Reflectance reflectance(const Object& object, std::string_view name, double fallback,
                                            VDirection v);
/// A number. A spectrum is reduced by `number_of`; a texture becomes a constant, which is noted.
[[nodiscard]] double number(const Object& object, std::string_view name, double fallback);
/// The file of a bitmap texture, with its mapping for a shape with the direction `v`. Nothing, after an
/// error, for a missing file; nothing, after a note, for another type of texture.
[[nodiscard]] std::optional<spec::TextureFile> image(const Object& texture, VDirection v);

/// The emission spectrum of the property called `name`, in W, nm, m2 and sr as in Mitsuba:
/// - Samples and temperatures are absolute.
/// - A spectrum of type "uniform" is constant.
/// - A colour or number c is D65 times c. For c = 1 its integral with the CIE 1931 y is that of the constant
///   spectrum 1.
/// - A spectrum of type "d65" is scaled alike, with its "scale" as c.
/// - A property that is absent, or has an error, counts as the number 1.
[[nodiscard]] ImportedLightSpectrum light_spectrum(const Object& object, std::string_view name);
/// Integral of the CIE 1931 y from 360 to 830 nm [nm].
[[nodiscard]] double y_integral();

}  // namespace abbe::importers::mitsuba
