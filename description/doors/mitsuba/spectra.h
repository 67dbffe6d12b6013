#pragma once

#include <optional>
#include <string_view>

#include "description/doors/mitsuba/object.h"
#include "description/doors/shared/spectra.h"

namespace abbe::doors::mitsuba {

/// Which way v runs on a shape's coordinates: with the rows of images, as in scenes there, or against them,
/// as it is read here from files whose v is turned round there.
enum class RunsOfV { down, up };

/// The spectrum of an element, such as <rgb>; nothing after an error.
[[nodiscard]] std::optional<Spectrum> spectrum_of(const Element& element, const World& world);
/// That of a property, `absent` without it.
[[nodiscard]] Spectrum spectrum(const Object& object, std::string_view name, const Spectrum& absent,
                                const World& world);
/// The same of a property that may be an image.
[[nodiscard]] TextureValue texture(const Object& object, std::string_view name, const Spectrum& absent,
                                   RunsOfV v, const World& world);
[[nodiscard]] spec::Reflectance reflectance(const Object& object, std::string_view name, double absent,
                                            RunsOfV v, const World& world);
/// A number, or what a texture says of it where it says one only.
[[nodiscard]] double number(const Object& object, std::string_view name, double absent, const World& world);
/// The image of a texture; nothing, after an error or a note, where it is none.
[[nodiscard]] std::optional<spec::TextureFile> image(const Object& texture, RunsOfV v, const World& world);

/// The lamp of a property: samples, and temperatures, are in W and nm; a colour or number c is D65 of which
/// the integral of the CIE 1931 y is that of c everywhere; a spectrum "uniform" is even.
[[nodiscard]] LampSpectrum lamp(const Object& object, std::string_view name, const World& world);
/// The integral of the CIE 1931 y [nm].
[[nodiscard]] double y_of_one();

}  // namespace abbe::doors::mitsuba
