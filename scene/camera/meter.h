#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera/camera.h"
#include "sensor/film/spectral_film.h"
#include "sensor/response/channel.h"

namespace abbe {

/// The quantity that a meter reports: per area, total, per area and solid angle, or per solid angle.
enum class MeterQuantity { irradiance, flux, radiance, intensity };
inline constexpr std::array kMeterQuantityNames{"irradiance", "flux", "radiance", "intensity"};

/// A probe that the scene file names, and the quantity to report.
struct Meter {
  std::string name;
  MeterQuantity quantity = MeterQuantity::irradiance;
  IrradianceProbe probe;
  /// Cells along the edges of a quad; each is reported too.
  std::array<int, 2> cells{1, 1};
  std::optional<SpectralBins> spectrum = {};  ///< Bins in which the light is reported too.
};

/// Factor from the irradiance by the accepted light to the meter's quantity. Let A be the area, s the sine of
/// the acceptance angle, and Omega = 2 pi (1 - sqrt(1 - s^2)) the solid angle of its cone. The factor is 1
/// for irradiance, A for flux, 1/(pi s^2) for mean radiance and A/Omega for mean intensity.
[[nodiscard]] double per_irradiance(const Meter& meter);

/// The meter as a camera. A pixel of its film is a part of a cell; the film has 32 or more pixels along each
/// side.
[[nodiscard]] Camera camera_of(const Meter& meter);

/// Channels of a meter's film: W, lm and micromoles of photons, per m^2 and over 300-1100 nm, then the energy
/// in each bin of its spectrum.
[[nodiscard]] std::vector<Channel> channels_of(const Meter& meter);
inline constexpr int kRadiantPlane = 0;
inline constexpr int kLuminousPlane = 1;
inline constexpr int kPhotonPlane = 2;
inline constexpr int kSpectrumPlane = 3;  ///< Index of the first bin.

}  // namespace abbe
