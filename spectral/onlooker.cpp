#include "spectral/onlooker.h"

namespace abbe {

Chromaticity chromaticity(const Curve& light, const Onlooker& onlooker) {
  return chromaticity(tristimulus(light, Curve(1.0), onlooker.observer));
}

}  // namespace abbe
