#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "io/error.h"
#include "scene/scene.h"
#include "spectral/wavelength_distribution.h"
#include "transport/path/medium_stack.h"
#include "transport/plan/caustic_guide.h"
#include "transport/plan/emissions.h"
#include "transport/plan/light_sampler.h"
#include "transport/plan/photon_guide.h"
#include "transport/plan/power_light_sampler.h"
#include "transport/plan/techniques.h"

namespace abbe {

/// Distributions that guide photons and camera paths; uniform until pilots have trained them.
struct GuidingData {
  std::vector<PhotonGuide> photon_guides;  ///< One per light if photons are traced.
  /// Wavelengths of photons whose packet is not that of camera paths.
  WavelengthDistribution photon_wavelengths;
  /// Caustics of lights that photons are not traced from, for camera paths.
  CausticGuide path_caustics = {};
  /// Caustics of all lights that camera paths can hit, for paths that arrive through specular surfaces.
  CausticGuide caustics_through_specular = {};
  /// True if a tenth of the pilots' film values, or more, comes from lights with too few pilot photons.
  bool undertrained = false;
  /// Fraction of the pilots' film values, weighted as for training, in branches with fewer than
  /// `PhotonGuide::kEnoughPhotons` photons each. The guide may be incomplete for these.
  double undertrained_fraction = 0;
};

/// Data that a render computes once from the scene: techniques and their lights, and all sampling
/// distributions.
struct Plan {
  const Scene& scene;
  WavelengthDistribution wavelengths;
  LightSampler path_lights;         ///< Lights for next-event estimation.
  PowerLightSampler traced_lights;  ///< Lights that emit photons.
  std::vector<bool> traced;         ///< Per light: true if the light tracer owns its caustics.
  GuidingData guides;
  std::vector<Technique> techniques;  ///< Those that own some path, in the order of the enumeration.
  std::uint64_t photons;              ///< Number per sample.
  std::uint32_t path_interval;        ///< A pixel has camera paths in one of this many samples.
  double nominal_value;               ///< Order of magnitude of a film value.
  /// Wavelengths per channel of a mosaic; empty if wavelengths of a path fall on several pixels.
  std::vector<WavelengthDistribution> channel_wavelengths;
  MediumStack camera_media;              ///< Media at the start of camera paths.
  std::vector<MediumStack> light_media;  ///< Media at each traced light.
  /// True if `camera_media` depends on time, or on the position on a lens or probe.
  bool camera_media_vary = false;
  /// True per light whose `light_media` depend on time; empty if nothing moves.
  std::vector<bool> light_media_vary = {};
  float gather_radius = 0;  ///< Radius for the first sample [m].
  /// Point and spot lights that camera paths connect to along scattering segments.
  PowerLightSampler equiangular_lights{std::vector<double>()};
  /// True if photons of the light tracer split into wavelengths at dispersive glass.
  bool photons_split_wavelengths = false;
  /// Base-2 logarithm of the number of paths into which a camera path splits at its first scattering surface.
  int log2_splits = 0;

  /// Wavelengths of camera paths through a pixel.
  [[nodiscard]] const WavelengthDistribution& wavelengths_at(int x, int y) const {
    return channel_wavelengths.empty()
               ? wavelengths
               : channel_wavelengths[static_cast<std::size_t>(scene.mosaic->at(x, y))];
  }
};

/// Number of photons per sample.
[[nodiscard]] std::uint64_t photons_of_sample(const Scene& scene);

/// Number of paths per sample that may expose any pixel: photons, or the camera paths of a lens that
/// disperses wavelengths; 0 if each pixel has only its own.
[[nodiscard]] std::uint64_t paths_to_any_pixel(const Plan& plan);

/// Error{scene} if the scene cannot be rendered, nothing otherwise. Either photons cannot illuminate it
/// although its integrator needs them: the error names the shape or distant light that is too large or too
/// far. Or exposure and lights are outside the range of floats.
[[nodiscard]] std::optional<Error> refusal(const Scene& scene);

/// Plan without training, from the scene alone. Throws the error of `refusal`.
[[nodiscard]] Plan make_plan(const Scene& scene);

/// Plan of pilots that trace photons from the given lights, whatever the scene's integrator. Nothing if none
/// of the lights has power, or if photons cannot start from them.
[[nodiscard]] std::optional<Plan> make_photon_plan(const Scene& scene, const Emissions& emissions,
                                                   const std::vector<bool>& lights);

}  // namespace abbe
