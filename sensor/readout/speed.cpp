#include "sensor/readout/speed.h"

#include <algorithm>
#include <utility>

#include "io/error.h"
#include "sensor/response/table_range.h"
#include "spectral/colorimetry.h"
#include "spectral/library.h"

namespace abbe {
namespace {

constexpr const char* kDaylight = "D55";
constexpr double kSaturationConstant = 78;  // lx s

NamedCurve daylight() {
  Diagnostics diagnostics;
  auto curve = load_curve("illuminant", kDaylight, {}, diagnostics);
  if (!curve) throw Error(diagnostics.code(), "", diagnostics.text());
  return *std::move(curve);
}

}  // namespace

std::optional<double> daylight_sensitivity(std::span<const Channel> channels, double gathering_area_m2) {
  const auto counts = [](const Channel& channel) { return channel.kind == ResponseKind::quantum; };
  if (!std::ranges::all_of(channels, counts)) return std::nullopt;
  const Curve illuminant = daylight().curve;
  double largest = 0;
  for (const Channel& channel : channels)
    largest = std::max(largest, integral_of_product(illuminant, channel.weight) / channel.exposure_ratio);
  return largest / photometric(illuminant) * gathering_area_m2;
}

void check_daylight(std::span<const Channel> channels, const SourcePosition& where,
                    Diagnostics& diagnostics) {
  check_light_range(daylight(), channels, where, diagnostics);
}

double saturation_electrons(const Readout& readout) {
  return std::min(readout.full_well_e, electrons_of(readout, readout.highest_code()));
}

double saturation_speed(const Readout& readout, double sensitivity_e_per_lx_s) {
  return kSaturationConstant * sensitivity_e_per_lx_s / saturation_electrons(readout);
}

double gain_of_speed(const Readout& readout, double speed, double sensitivity_e_per_lx_s) {
  return kSaturationConstant * sensitivity_e_per_lx_s / speed / (readout.highest_code() - readout.offset_dn);
}

}  // namespace abbe
