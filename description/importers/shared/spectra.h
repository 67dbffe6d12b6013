#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/importers/shared/scene_importer.h"
#include "spectral/rgb.h"

namespace abbe::importers {

/// Samples of a spectrum, in strictly ascending wavelength.
struct Samples {
  std::vector<double> nm;
  std::vector<double> values;
  Outside outside = Outside::clamp;
};
/// Temperature of a black body [K].
struct Temperature {
  double K = 0;
};
/// A shipped table times a factor.
struct ShippedTable {
  std::string name;
  double factor = 1;
};
/// A spectrum in a form of the source renderers: a constant, a linear Rec.709 colour, or one of the above.
using Spectrum = std::variant<double, LinearRgb, Samples, Temperature, ShippedTable>;

using TextureValue = std::variant<Spectrum, spec::Texture>;

/// True if there are two samples or more and wavelengths ascend; otherwise reports an error.
[[nodiscard]] bool check_samples(const Samples& samples, const SourcePosition& where,
                                 SceneImporter& importer);

/// The spectrum of a colour as a mixture of `rgb_basis`, every 5 nm from 380 to 780 nm.
[[nodiscard]] Samples samples_of(const LinearRgb& rgb);
/// Converts a spectrum to a curve. A colour becomes a smooth spectrum with that colour under D65
/// (`rgb_spectrum`), which is noted unless it is grey.
[[nodiscard]] spec::Curve curve_of(const Spectrum& spectrum, const SourcePosition& where,
                                   SceneImporter& importer);
/// The texture of a colour image. `linear` makes integer codes linear: the channels then weight the basis
/// spectra, which is noted as in `curve_of`.
[[nodiscard]] spec::Texture colours_of(spec::TextureFile file, bool linear, const SourcePosition& where,
                                       SceneImporter& importer);
/// Applies a function with f(0) = 0 to the samples, and to values interpolated every 5 nm, since linear
/// interpolation and the function do not commute.
[[nodiscard]] Samples mapped(const Samples& samples, const std::function<double(double)>& function);
/// Extends samples that are 0 outside their range by rows with the value `outside_value` up to the ends of
/// the rendered range. Other samples are returned as they are. Values are then constant outside.
[[nodiscard]] Samples extend_constant(Samples samples, double outside_value);
/// Applies such a function to a spectrum; colours are converted as in `curve_of`. Nothing for a temperature
/// or a table.
[[nodiscard]] std::optional<spec::Curve> mapped_curve_of(const Spectrum& spectrum,
                                                         const std::function<double(double)>& function,
                                                         const SourcePosition& where,
                                                         SceneImporter& importer);
/// The spectrum times a factor.
[[nodiscard]] Spectrum scaled(Spectrum spectrum, double factor);
/// A single number for a spectrum: the value at 589.3 nm for samples, the mean for colours. Nothing for a
/// temperature or a table.
[[nodiscard]] std::optional<double> number_of(const Spectrum& spectrum);
/// The index of refraction from spectra of n and k, which are numbers, colours or samples. Colours are
/// converted as in `curve_of`. Reports spectra of lights and negative colour components.
[[nodiscard]] spec::Ior index_of(const Spectrum& n_spectrum, const Spectrum& k_spectrum,
                                 const SourcePosition& where, SceneImporter& importer);

/// The emission spectrum of a light. Unless the spectrum has a unit of its own, `photometric` is its
/// luminance [cd/m2], luminous intensity [cd] or illuminance [lx].
struct ImportedLightSpectrum {
  spec::Emission emission{};
  std::optional<double> photometric{};
};
/// An emission spectrum of which only the shape counts. It is scaled so that the integral of spectral
/// radiance, intensity or irradiance times the CIE 1931 y equals `y`. For colours, `y` belongs to (1, 1, 1),
/// which is D65; other colours give less.
[[nodiscard]] ImportedLightSpectrum light_spectrum_of(const Spectrum& spectrum, double y,
                                                      const SourcePosition& where, SceneImporter& importer);
/// An emission spectrum whose samples and temperatures are in W and nm, times `factor`. Colours and numbers
/// are as in `light_spectrum_of`, with 1 giving `y`.
[[nodiscard]] ImportedLightSpectrum absolute_light_spectrum_of(const Spectrum& spectrum, double factor,
                                                               double y, const SourcePosition& where,
                                                               SceneImporter& importer);

/// The emission of one type of light, with the spectrum scaled to its photometric quantity.
template <typename Emission, spec::Quantity quantity>
[[nodiscard]] Emission emission_of(const ImportedLightSpectrum& light) {
  Emission emission;
  static_cast<spec::Emission&>(emission) = light.emission;
  if (light.photometric) emission.scale = spec::Amount<quantity>{{*light.photometric}};
  return emission;
}

}  // namespace abbe::importers
