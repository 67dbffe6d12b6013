#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "io/error.h"
#include "scene/scene.h"
#include "spectral/wavelength_distribution.h"
#include "transport/light/aim.h"
#include "transport/path/medium.h"

namespace abbe {

/// A discrete distribution over the lights of a scene.
class LightPicker {
 public:
  /// Proportional to `weights`, nine parts in ten, and uniform over the lights of positive weight for the
  /// rest.
  explicit LightPicker(const std::vector<double>& weights);

  struct Pick {
    std::uint32_t light;
    float probability;
  };
  [[nodiscard]] Pick pick(float u) const;
  [[nodiscard]] float probability(std::uint32_t light) const { return probability_[light]; }
  [[nodiscard]] bool empty() const { return cdf_.empty(); }

 private:
  std::vector<float> cdf_;  // empty when no light has weight
  std::vector<float> probability_;
};

/// What a render works out once from the scene: which technique owns which light's caustics, where
/// wavelengths and lights are drawn from, and where photons are aimed.
struct Plan {
  const Scene& scene;
  WavelengthDistribution wavelengths;
  LightPicker path_lights;    ///< For light sampling at path vertices.
  LightPicker traced_lights;  ///< For starting photons.
  std::vector<bool> traced;   ///< Per light: the light tracer owns its caustics.
  std::vector<Aim> aims;      ///< Per light where photons start at all.
  bool path_active;
  bool light_active;
  bool light_owns_all;                                  ///< The light tracer alone renders the scene.
  double nominal_value;                                 ///< Order of magnitude of a film value.
  std::vector<WavelengthDistribution> own_wavelengths;  ///< Per channel, for the pixels of a mosaic.
  Enclosures camera_inside;                             ///< Where camera paths start,
  std::vector<Enclosures> light_inside;                 ///< and photons, likewise.

  /// Where camera paths through a pixel draw theirs from; photons, which may meet any pixel, draw from
  /// `wavelengths`.
  [[nodiscard]] const WavelengthDistribution& wavelengths_at(int x, int y) const {
    return own_wavelengths.empty() ? wavelengths
                                   : own_wavelengths[static_cast<std::size_t>(scene.mosaic->at(x, y))];
  }
};

/// Whether photons are traced: the integrator allows it, and the scene asks for it or there is no other way.
[[nodiscard]] bool traces_light(const Scene& scene);

/// Why photons cannot light a scene that would have them: a shape that light from afar meets is too large or
/// too far for them, or a far lamp too large; Error{scene} with its name. Nothing where a plan can be made.
[[nodiscard]] std::optional<Error> refusal(const Scene& scene);

/// On that many threads, which change nothing but the time it takes. What it learns from pilots depends on
/// `seed`, by default the render's. Throws what `refusal` tells.
[[nodiscard]] Plan make_plan(const Scene& scene, int threads = 1);
[[nodiscard]] Plan make_plan(const Scene& scene, int threads, std::uint64_t seed);

}  // namespace abbe
