#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "importers/shared/scene_importer.h"
#include "spectral/rgb.h"

namespace abbe::importers {

/// Samples of a spectrum, linearly interpolated.
struct Samples {
  std::vector<double> nm;            ///< Wavelengths, strictly ascending, two or more; see `checked`.
  std::vector<double> values;        ///< One value per wavelength, in the unit of the use.
  Outside outside = Outside::clamp;  ///< Values outside the wavelengths: those of the ends, or 0.
};
/// Temperature of a black body, whose spectrum is Planck's spectral radiance times a factor.
struct Temperature {
  double K = 0;
  double factor = 1;
};
/// A shipped illuminant times a factor.
struct ShippedTable {
  std::string name;  ///< Name of a table of `data/illuminant`, such as "D65".
  double factor = 1;
};
/// A spectrum in a form of the source renderers: a constant, a linear Rec.709 colour, or one of the above.
using Spectrum = std::variant<double, LinearRgb, Samples, Temperature, ShippedTable>;

/// The value of a property that may vary over a surface: a spectrum, or an image.
using TextureValue = std::variant<Spectrum, spec::Texture>;

/// The samples. Nothing, after an error at `where`, if there are fewer than two, or wavelengths do not ascend
/// strictly.
[[nodiscard]] std::optional<Samples> checked(Samples samples, const SourcePosition& where,
                                             SceneImporter& importer);
/// Samples from an even number of numbers, wavelength [nm] and value in turn, that are 0 outside. Checks them
/// as `checked`.
[[nodiscard]] std::optional<Samples> samples_of_pairs(const std::vector<double>& pairs,
                                                      const SourcePosition& where, SceneImporter& importer);

/// The spectrum of a linear Rec.709 colour as a mixture of `rgb_basis`, every 5 nm from 380 to 780 nm and
/// rounded to 1e-6.
[[nodiscard]] Samples samples_of(const LinearRgb& rgb);
/// The curve of a spectrum. A grey colour becomes a constant; any other colour a smooth spectrum with that
/// colour under D65 (`rgb_spectrum`), which is noted. A temperature becomes Planck's spectral radiance [W/(m2
/// sr nm)].
[[nodiscard]] spec::Curve curve_of(const Spectrum& spectrum, const SourcePosition& where,
                                   SceneImporter& importer);
/// The texture of a colour image. If `linear`, integer codes are taken as linear instead of sRGB: the
/// channels then weight the spectra of `rgb_basis`, which is noted.
[[nodiscard]] spec::Texture colours_of(spec::TextureFile file, bool linear, const SourcePosition& where,
                                       SceneImporter& importer);
/// Applies a function to the samples. Values interpolated every 5 nm are added before, since linear
/// interpolation and the function do not commute. The function must have f(0) = 0 if the samples are 0
/// outside their range, because they stay 0 there.
[[nodiscard]] Samples mapped(const Samples& samples, const std::function<double(double)>& function);
/// Extends samples that are 0 outside their range by rows with the value `outside_value` up to 300 and 1100
/// nm, the ends of the rendered range. Samples that clamp are returned unchanged. The result clamps.
[[nodiscard]] Samples extend_constant(Samples samples, double outside_value);
/// Applies a function to a spectrum as `mapped` does, with the same condition f(0) = 0. Colours are converted
/// first, as in `curve_of`. Nothing, without an error, for a temperature or a shipped table.
[[nodiscard]] std::optional<spec::Curve> mapped_curve_of(const Spectrum& spectrum,
                                                         const std::function<double(double)>& function,
                                                         const SourcePosition& where,
                                                         SceneImporter& importer);
[[nodiscard]] Spectrum scaled(Spectrum spectrum, double factor);
/// A single number for a spectrum: the value at 589.3 nm for samples, the mean of the components for colours.
/// Nothing, without an error, for a temperature or a shipped table.
[[nodiscard]] std::optional<double> number_of(const Spectrum& spectrum);
/// The complex refractive index n + ik from spectra of n and k, which are numbers, colours or samples:
/// - Two numbers, or n = 0 with any k, give a constant index; n = 0 reflects everything.
/// - Samples give a table at all wavelengths of either, clamped at its ends.
/// - Colours are converted as in `curve_of`, with values of at least 1e-6.
/// Reports temperatures, shipped tables and negative colour components; the result is then unusable.
[[nodiscard]] spec::Ior index_of(const Spectrum& n_spectrum, const Spectrum& k_spectrum,
                                 const SourcePosition& where, SceneImporter& importer);

/// The emission spectrum of a light, before the type of light is chosen.
struct ImportedLightSpectrum {
  spec::Emission emission{};  ///< The spectrum, without a scale.
  /// Luminance [cd/m2], luminous intensity [cd], illuminance [lx] or luminous flux [lm] to which the spectrum
  /// is scaled. The caller knows which of them. Nothing if the spectrum is absolute.
  std::optional<double> photometric{};
};
/// An emission spectrum of which only the shape counts. `photometric` is set so that the integral of spectral
/// radiance, intensity or irradiance times the CIE 1931 y equals `y`, in W/(m2 sr), W/sr or W/m2.
/// - A colour is D65 times its smooth spectrum. `y` belongs to (1, 1, 1); other colours give their luminance
///   relative to it.
/// - A number is the equal-energy spectrum E, whatever its value; factors have no effect either.
/// Throws Error{input} if the table of D65 cannot be read, for a colour that is not grey.
[[nodiscard]] ImportedLightSpectrum light_spectrum_of(const Spectrum& spectrum, double y,
                                                      const SourcePosition& where, SceneImporter& importer);
/// An emission spectrum whose samples, temperatures and shipped tables are absolute, in W and nm;
/// `photometric` is then absent. A number c counts as the colour (c, c, c). Colours are as in
/// `light_spectrum_of`.
[[nodiscard]] ImportedLightSpectrum absolute_light_spectrum_of(const Spectrum& spectrum, double y,
                                                               const SourcePosition& where,
                                                               SceneImporter& importer);

/// The emission of a light. Its scale is `light.photometric` as `quantity`, or none if that is absent.
template <spec::Quantity quantity>
[[nodiscard]] spec::Emission emission_of(const ImportedLightSpectrum& light) {
  spec::Emission emission = light.emission;
  if (light.photometric) emission.scale = spec::Amount<quantity>{{*light.photometric}};
  return emission;
}
/// Adds a light of the type `Light`, an alternative of `spec::Light::kind`, with the emission
/// `emission_of<quantity>`.
template <typename Light, spec::Quantity quantity>
void append_light(decltype(Light::source) source, const ImportedLightSpectrum& emitted,
                  const SourcePosition& where, SceneImporter& importer) {
  using Emission = typename decltype(std::optional(Light::emission))::value_type;
  importer.reserve_values(kValuesPerItem);
  spec::Light light;
  light.kind = Light{std::move(source), Emission{emission_of<quantity>(emitted)}};
  light.where = where;
  importer.scene.lights.push_back(std::move(light));
}

/// Reads a text file with a wavelength [nm] and a value per line, separated by blanks, tabs or a comma; `#`
/// begins a comment. The samples are 0 outside. Nothing after an error: a missing or unreadable file, at
/// `where`, a malformed line, and the errors of `checked`.
[[nodiscard]] std::optional<Samples> read_spectrum_file(const std::filesystem::path& file,
                                                        const SourcePosition& where, SceneImporter& importer);

}  // namespace abbe::importers
