#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera/camera.h"
#include "sensor/film/spectral_film.h"
#include "sensor/response/channel.h"

namespace abbe {

/// What a meter tells: per area, as a whole, per area and solid angle, or per solid angle.
enum class MeterQuantity { irradiance, flux, radiance, intensity };
inline constexpr std::array kMeterQuantityNames{"irradiance", "flux", "radiance", "intensity"};

/// A meter that a scene names.
struct Meter {
  std::string name;
  MeterQuantity quantity = MeterQuantity::irradiance;
  Probe probe;
  std::array<int, 2> cells{1, 1};             ///< Parts along the edges of a quad, each of which is told too.
  std::optional<SpectralBins> spectrum = {};  ///< In which the light is told too.
};

/// The quantity over the irradiance by the light that the meter counts: with its area A and the sine s of its
/// acceptance, that of a cone of the solid angle Omega = 2 pi (1 - sqrt(1 - s^2)), it is 1 of an irradiance,
/// A of a flux, 1/(pi s^2) of the mean radiance, and A/Omega of the mean intensity.
[[nodiscard]] double per_irradiance(const Meter& meter);

/// The meter as a camera: a pixel of its film is a part of a cell, 32 or more of them along
/// either side.
[[nodiscard]] Camera camera_of(const Meter& meter);

/// What the film of a meter has: W, lm and micromoles of photons per m^2, over 300-1100 nm, then the energies
/// in the bins of its spectrum.
[[nodiscard]] std::vector<Channel> channels_of(const Meter& meter);
inline constexpr int kRadiantPlane = 0;
inline constexpr int kLuminousPlane = 1;
inline constexpr int kPhotonPlane = 2;
inline constexpr int kSpectrumPlane = 3;  ///< The first of them.

}  // namespace abbe
