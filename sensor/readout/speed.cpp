#include "sensor/readout/speed.h"

#include <algorithm>

#include "io/error.h"
#include "spectral/colorimetry.h"

namespace abbe {

double sensitivity_e_per_lx_s(std::span<const Channel> channels, double gathering_area_m2,
                              const Curve& illuminant) {
  double most = 0;
  for (const Channel& channel : channels) {
    if (channel.kind != ResponseKind::quantum)
      throw Error(ErrorCode::internal, channel.name, "the speed of a channel that counts no electrons");
    most = std::max(most, integral_of_product(illuminant, channel.weight) / channel.exposure_ratio);
  }
  return most / photometric(illuminant) * gathering_area_m2;
}

double saturation_speed(const Readout& readout, double sensitivity_e_per_lx_s) {
  constexpr double kSaturationConstant = 78;  // lx s
  const double saturation_e = std::min(readout.full_well_e, electrons_of(readout, readout.highest_code()));
  return kSaturationConstant * sensitivity_e_per_lx_s / saturation_e;
}

}  // namespace abbe
