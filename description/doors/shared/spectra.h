#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/doors/shared/door.h"
#include "spectral/rgb.h"

namespace abbe::doors {

/// Samples of a spectrum, strictly ascending in wavelength.
struct Samples {
  std::vector<double> nm;
  std::vector<double> values;
  Outside outside = Outside::clamp;
};
/// Of a black body [K].
struct Temperature {
  double K = 0;
};
/// A shipped table by its name here, times a factor.
struct Shipped {
  std::string name;
  double factor = 1;
};
/// A spectrum as other renderers say it: a constant, a linear Rec.709 colour, or one of the above.
using Spectrum = std::variant<double, LinearRgb, Samples, Temperature, Shipped>;

/// A spectrum, or an image.
using TextureValue = std::variant<Spectrum, spec::Texture>;

/// Whether the samples ascend and are two or more; what is wrong is reported.
[[nodiscard]] bool check_samples(const Samples& samples, const SourcePosition& where, Door& door);

/// The mixture of `rgb_basis` that a colour is, every 5 nm where colours say something.
[[nodiscard]] Samples samples_of(const LinearRgb& rgb);
/// The curve. A colour becomes the smooth spectrum that looks so under D65 (see `rgb_spectrum`), which is
/// noted unless it is grey.
[[nodiscard]] spec::Curve curve_of(const Spectrum& spectrum, const SourcePosition& where, Door& door);
/// The texture of an image's colours; `linear`: also of files that hold codes, whose channels weigh the basis
/// then, which is noted as above.
[[nodiscard]] spec::Texture colours_of(spec::TextureFile file, bool linear, const SourcePosition& where,
                                       Door& door);
/// The values through a function that leaves 0 where it is: of samples at each of them and, as lines between
/// these say something else then, at every 5 nm.
[[nodiscard]] Samples mapped(const Samples& samples, const std::function<double(double)>& function);
/// The same held beyond its ends: of samples that are 0 there with rows more of what becomes of 0, from the
/// next number on to the end of all wavelengths.
[[nodiscard]] Samples held(Samples samples, double beyond);
/// The curve of the values through such a function, a colour's as those of `curve_of`; nothing for a
/// temperature or a table.
[[nodiscard]] std::optional<spec::Curve> mapped_curve_of(const Spectrum& spectrum,
                                                         const std::function<double(double)>& function,
                                                         const SourcePosition& where, Door& door);
/// The values times a factor.
[[nodiscard]] Spectrum scaled(Spectrum spectrum, double factor);
/// The number that stands for a spectrum where only one can: of samples the value at 589.3 nm, of a colour
/// the mean; nothing for a temperature or a table.
[[nodiscard]] std::optional<double> number_of(const Spectrum& spectrum);
/// Numbers, colours or samples of n and k as one index, a metal's or a glass's: colours by their smooth
/// spectra, as by `curve_of`. Reports the spectrum of a lamp and parts of colours below 0.
[[nodiscard]] spec::Ior index_of(const Spectrum& said_n, const Spectrum& said_k, const SourcePosition& where,
                                 Door& door);

/// The spectrum of a lamp and, unless the spectrum has a unit of its own, its luminance [cd/m2], luminous
/// intensity [cd] or illuminance [lx].
struct LampSpectrum {
  spec::Emission emission{};
  std::optional<double> photometric{};
};
/// A lamp whose spectrum counts by its shape, so that the integral of its spectral radiance, intensity or
/// irradiance [W/nm ...] times the CIE 1931 y is `y`. Of a colour (1, 1, 1), which is D65, others less.
[[nodiscard]] LampSpectrum lamp_of(const Spectrum& spectrum, double y, const SourcePosition& where,
                                   Door& door);
/// A lamp whose samples and temperatures are in W and nm times `factor`; a colour or number is that of
/// `lamp_of`, 1 giving `y`.
[[nodiscard]] LampSpectrum absolute_lamp_of(const Spectrum& spectrum, double factor, double y,
                                            const SourcePosition& where, Door& door);

/// The emission of one kind of lamp: the spectrum scaled to that quantity.
template <typename Emission, spec::Quantity quantity>
[[nodiscard]] Emission emission_of(const LampSpectrum& lamp) {
  Emission emission;
  static_cast<spec::Emission&>(emission) = lamp.emission;
  if (lamp.photometric) emission.scale = spec::Amount<quantity>{{*lamp.photometric}};
  return emission;
}

}  // namespace abbe::doors
