#include "sensor/readout/speed.h"

#include <algorithm>

#include "io/error.h"
#include "spectral/colorimetry.h"

namespace abbe {

double saturation_speed(const Readout& readout, std::span<const Channel> channels, double gathering_area_m2,
                        const Curve& illuminant) {
  constexpr double kSaturationConstant = 78;  // lx s
  double most_e_per_lx_s = 0;
  for (const Channel& channel : channels) {
    if (channel.kind != ResponseKind::quantum)
      throw Error(ErrorCode::internal, channel.name, "the speed of a channel that counts no electrons");
    most_e_per_lx_s = std::max(most_e_per_lx_s, integral_of_product(illuminant, channel.weight) /
                                                    photometric(illuminant) * gathering_area_m2);
  }
  const double saturation_e = std::min(readout.full_well_e, electrons_of(readout, readout.highest_code()));
  return kSaturationConstant * most_e_per_lx_s / saturation_e;
}

}  // namespace abbe
