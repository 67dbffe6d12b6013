#include "scene/white.h"

#include <utility>

namespace abbe {

White white_of(const Light& light, std::string reason) {
  Curve spectrum = mean_emission(light).curve();
  const Chromaticity xy = chromaticity(spectrum);
  return {light.name, std::move(reason), xy, std::move(spectrum)};
}

}  // namespace abbe
