#include "scene/camera/meter.h"

#include <cmath>
#include <numbers>

#include "materials/bsdf/warp.h"
#include "spectral/sources.h"

namespace abbe {

double per_irradiance(const Meter& meter) {
  const double s = meter.probe.acceptance;
  const double cone = 2 * std::numbers::pi * s * s / (1 + std::sqrt((1 - s) * (1 + s)));
  switch (meter.quantity) {
    case MeterQuantity::irradiance:
      return 1;
    case MeterQuantity::flux:
      return meter.probe.area();
    case MeterQuantity::radiance:
      return 1 / disc_area(s);
    case MeterQuantity::intensity:
      return meter.probe.area() / cone;
  }
  return 1;
}

Camera camera_of(const Meter& meter) {
  constexpr int kAcross = 32;  // four tiles
  const auto& [columns, rows] = meter.cells;
  const auto next_multiple = [](int cells) { return (kAcross + cells - 1) / cells * cells; };
  return {meter.probe, next_multiple(columns), next_multiple(rows), 1};
}

std::vector<Channel> channels_of(const Meter& meter) {
  std::vector<Channel> channels{energy_channel("radiant", Curve(1.0)),
                                observer_channels(Observer::cie1931)[1],
                                scaled(quantum_channel("photons", Curve(1.0)), 1e6 / kAvogadro)};
  if (meter.spectrum)
    for (Channel& bin : spectral_channels(*meter.spectrum)) channels.push_back(std::move(bin));
  return channels;
}

}  // namespace abbe
