#include "scene/colors.h"

namespace abbe {

bool has_colors(const Scene& scene) {
  return scene.spectral || scene.channels.size() == 3;
}

}  // namespace abbe
