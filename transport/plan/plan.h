#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "io/error.h"
#include "scene/scene.h"
#include "spectral/wavelength_distribution.h"
#include "transport/path/medium_stack.h"
#include "transport/plan/aim.h"
#include "transport/plan/caustic_guide.h"
#include "transport/plan/emissions.h"
#include "transport/plan/light_sampler.h"
#include "transport/plan/power_light_sampler.h"
#include "transport/plan/techniques.h"

namespace abbe {

/// Where photons and camera paths go to find light: alike everywhere, until pilots have taught it.
struct Guides {
  std::vector<Aim> aims;  ///< Per light where photons start at all.
  /// Where photons that share no packet with camera paths draw their wavelengths from.
  WavelengthDistribution photon_wavelengths;
  /// Where camera paths look for the caustics of lights that photons are not traced from,
  CausticGuide caustics_of_paths = {};
  /// and of all lights that they can meet, once they have come through specular matter from the camera.
  CausticGuide caustics_seen_through = {};
  /// Whether a tenth of what photons of pilots bring the film, or more, is brought by too few to aim by.
  bool photons_are_rare = false;
  /// Fraction of the film's light, as weighted in training, on branches that fewer than `Aim::kEnough` pilot
  /// photons took. The guide knows these branches badly, so that their error is uncertain.
  double undertrained_fraction = 0;
};

/// What a render works out once from the scene: which technique owns which light's caustics, where
/// wavelengths and lights are drawn from, and where photons are aimed.
struct Plan {
  const Scene& scene;
  WavelengthDistribution wavelengths;
  LightSampler path_lights;         ///< For light sampling at path vertices.
  PowerLightSampler traced_lights;  ///< For starting photons.
  std::vector<bool> traced;         ///< Per light: the light tracer owns its caustics.
  Guides guides;
  std::vector<Technique> techniques;  ///< In the order of their list; those that own some path.
  std::uint64_t photons;              ///< Of a sample.
  std::uint32_t path_interval;        ///< A pixel has camera paths in one of so many samples.
  double nominal_value;               ///< Order of magnitude of a film value.
  /// Per channel, for the pixels of a mosaic; none where lanes of a path fall on several pixels.
  std::vector<WavelengthDistribution> own_wavelengths;
  MediumStack camera_inside;              ///< Where camera paths start,
  std::vector<MediumStack> light_inside;  ///< and photons, likewise.
  bool camera_matter_varies = false;      ///< Whether that depends on time, or on where on a lens or meter,
  std::vector<bool> light_matter_moves = {};  ///< and per light on time; none where nothing moves.
  float gather_radius = 0;                    ///< Of the first sample [m].
  /// Those at points that camera paths connect to along matter that scatters.
  PowerLightSampler lights_along{std::vector<double>()};
  /// Whether those of light tracing go on lane by lane where glass disperses them, each along its own way.
  bool photons_part = false;
  /// Each camera path goes on in 2^this where it first scatters, if light is to be found behind.
  int split_bits = 0;

  /// Where camera paths through a pixel draw theirs from.
  [[nodiscard]] const WavelengthDistribution& wavelengths_at(int x, int y) const {
    return own_wavelengths.empty() ? wavelengths
                                   : own_wavelengths[static_cast<std::size_t>(scene.mosaic->at(x, y))];
  }
};

/// How many photons the scene asks for in a sample.
[[nodiscard]] std::uint64_t photons_of_sample(const Scene& scene);

/// How many paths of a sample may expose any pixel: the photons, or where there are none the camera paths
/// through a lens that displaces lanes; 0 where each pixel has its own alone.
[[nodiscard]] std::uint64_t paths_to_any_pixel(const Plan& plan);

/// Why a scene cannot be rendered, as Error{scene}; nothing where a plan can be made. Photons cannot light it
/// though it would have them, since a shape that light from afar meets is too large or too far for them, or a
/// far lamp too large: the error names it. Or exposure and lights are so weak that floats hold nothing of it.
[[nodiscard]] std::optional<Error> refusal(const Scene& scene);

/// What can be told without tracing a path: photons are aimed at all of their targets alike. Throws what
/// `refusal` tells.
[[nodiscard]] Plan make_plan(const Scene& scene);

/// The plan of pilots that start photons from some lights of a scene of these emissions, whatever techniques
/// the scene asks for. Nothing where none of them has power, or their photons are refused.
[[nodiscard]] std::optional<Plan> make_photon_plan(const Scene& scene, const Emissions& emissions,
                                                   const std::vector<bool>& lights);

}  // namespace abbe
