#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/image.h"

namespace abbe {

/// What a light's layer of a film counts: one factor for all planes, or one for each.
struct LightFactor {
  std::string light;  ///< As the layer is called, without `light.` before it.
  std::vector<double> factors;
};

/// What a light's layer gives the film as it is, and as often as it is to count, on a scale that all lights
/// of a film share: luminance for the observer and for spectral films, else the sum of the film values of all
/// channels, as `main_light` has it.
struct LightShare {
  std::string light;
  double before;
  double after;
};
/// That of all lights that a film has layers of. Throws as `relight` does.
[[nodiscard]] std::vector<LightShare> light_shares(const Image& film, std::span<const LightFactor> factors);

/// Whether a film counts what an observer sees, whose colours are right in any light.
[[nodiscard]] bool is_of_observer(const Image& film);

/// Adds a film up anew out of its layers of lights, those that are not named counting as they did; the film
/// then has no layers any more, and tells the factors under `relit`. Factors of planes are in the order of
/// the sensor's channels, or of wavelength; the preview of a spectral film whose bands are weighed apart is
/// left out. Layers share their paths, so that their errors are not independent: with any
/// share w of the film F itself, sum_g w_g L_g = w F + sum_g (w_g - w) L_g, whose standard deviation is at
/// most
///     |w| sigma_F + sum_g |w_g - w| sigma_g,
/// and the variance is the square of the least of these bounds: that of the film, scaled, where all factors
/// are one. Throws Error{usage} for a film without such layers, for a light that has none or is named twice,
/// and for factors that are neither one nor as many as the film's planes.
void relight(Image& film, std::span<const LightFactor> factors);

}  // namespace abbe
