#include "scene/colors.h"

#include "sensor/response/stokes_channels.h"

namespace abbe {

bool has_colors(const Scene& scene) {
  return scene.spectral || count_intensities(scene.channels) == 3;
}

}  // namespace abbe
