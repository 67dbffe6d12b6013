#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera/camera.h"
#include "sensor/film/spectral_film.h"
#include "sensor/response/channel.h"

namespace abbe {

/// The quantity that a meter reports: per area [1/m^2], total, per area and solid angle [1/(m^2 sr)], or per
/// solid angle [1/sr].
enum class MeterQuantity { irradiance, flux, radiance, intensity };
/// Names of the quantities in scene files and results, in the order of the enumeration.
inline constexpr std::array kMeterQuantityNames{"irradiance", "flux", "radiance", "intensity"};

/// A probe that the scene file names, and the quantity to report.
struct Meter {
  std::string name;
  MeterQuantity quantity = MeterQuantity::irradiance;
  IrradianceProbe probe;
  /// Numbers of cells along `edge_u` and `edge_v` of a quad; each cell is reported too. {1, 1}: none besides
  /// the whole.
  std::array<int, 2> cells{1, 1};
  std::optional<SpectralBins> spectrum = {};  ///< Bins in which the light is reported too.
};

/// Factor from the irradiance by the accepted light to the meter's quantity. Let A [m^2] be the area, s the
/// sine of the acceptance angle, and Omega = 2 pi (1 - sqrt(1 - s^2)) [sr] the solid angle of its cone. The
/// factor is 1 for irradiance, A [m^2] for flux, 1/(pi s^2) [1/sr] for mean radiance and A/Omega [m^2/sr] for
/// mean intensity. For a point A is 0.
[[nodiscard]] double per_irradiance(const Meter& meter);

/// The meter as a camera. A pixel of its film is a part of a cell. Along each side the film has the smallest
/// multiple of the number of cells that is at least 32 pixels. Its pixel pitch is 1 and has no effect.
[[nodiscard]] Camera camera_of(const Meter& meter);

/// Channels of a meter's film. Film values are exposures. Divided by the exposure time, they are irradiances,
/// in this order:
/// - radiant [W/m^2], luminous for CIE 1931 [lm/m^2] and photon [umol/(s m^2)], over 300 to 1100 nm;
/// - the radiant irradiance in each bin of its spectrum [W/m^2], not per nm.
[[nodiscard]] std::vector<Channel> channels_of(const Meter& meter);
/// Index of the radiant channel; those of the other channels follow.
inline constexpr int kRadiantPlane = 0;
inline constexpr int kLuminousPlane = 1;
inline constexpr int kPhotonPlane = 2;
inline constexpr int kSpectrumPlane = 3;  ///< Index of the first bin of the spectrum.

}  // namespace abbe
