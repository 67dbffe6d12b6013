#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/image.h"

namespace abbe {

/// Factors that multiply the layer of a light.
struct LightFactor {
  std::string light;            ///< Name of the layer, without the prefix `light.`.
  std::vector<double> factors;  ///< One for all planes, or one for each in the order of `relight`.
};

/// Contribution of a light's layer to the film, averaged over all pixels, before and after its factors. The
/// unit is the same for all lights. It is luminance for an observer and for spectral films, else the sum of
/// film values over all channels, as in `main_light`.
struct LightContribution {
  std::string light;
  double before;
  double after;
};
/// Contributions of all lights that have a layer in the film. Throws Error{usage} as `relight`.
[[nodiscard]] std::vector<LightContribution> light_contributions(const Image& film,
                                                                 std::span<const LightFactor> factors);

/// True if the film records tristimulus values X, Y, Z, whose colours are correct under any light.
[[nodiscard]] bool is_of_observer(const Image& film);

/// Recomputes a film as the sum of its light layers, with the factor 1 for lights that are not named.
/// Afterwards the film has no layers, and the attribute `relit` records the factors. Factors of planes are in
/// the order of the sensor's channels or of wavelength. The preview of a spectral film is removed if the
/// bands of a light have different factors.
///
/// Layers of one film use the same paths, so their errors are correlated. For any weight w of the film F:
///     sum_g w_g L_g = w F + sum_g (w_g - w) L_g .
/// The standard deviation of this sum is at most
///     |w| sigma_F + sum_g |w_g - w| sigma_g.
/// The variance is the square of the smallest of these bounds. If all factors are equal it is the scaled
/// variance of the film.
///
/// Throws Error{usage} if the film has no such layers, or if a light has no layer or is named twice. Also
/// throws it if the number of factors is neither one nor that of the planes.
void relight(Image& film, std::span<const LightFactor> factors);

}  // namespace abbe
