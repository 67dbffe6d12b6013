#pragma once

#include <optional>
#include <vector>

#include "description/load_context.h"
#include "io/object_reader.h"
#include "scene/scene.h"

namespace abbe::description {

/// The film: its pixels, and what they count.
struct Sensor {
  int width = 1;
  int height = 1;
  double pixel_pitch = 4.5e-6;  ///< [m]
  double fill_factor = 1;
  double exposure_s = 1;
  std::vector<Channel> channels;
  std::optional<Readout> readout;
  std::optional<Mosaic> mosaic;
  std::optional<SpectralBins> spectral;
};
/// `probe`: the sensor of an irradiance probe has one pixel unless it says otherwise.
[[nodiscard]] Sensor read_sensor(const JsonValue& json, bool probe, LoadContext& context);

/// Bins of wavelength instead of channels.
[[nodiscard]] std::optional<SpectralBins> read_spectral(const JsonValue& json, const LoadContext& context);

/// What the pixels of a sensor count, with its filters; the sensor's exposure is that of channels without
/// their own.
void read_channels(ObjectReader& reader, Sensor& sensor, LoadContext& context);

}  // namespace abbe::description
