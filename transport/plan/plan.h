#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "io/error.h"
#include "scene/scene.h"
#include "spectral/curve.h"
#include "spectral/wavelength_distribution.h"
#include "transport/path/media.h"
#include "transport/plan/caustic_guide.h"
#include "transport/plan/light_sampler.h"
#include "transport/plan/photon_guide.h"
#include "transport/plan/techniques.h"

namespace abbe {

/// Emission of a scene's lights as weighted by its sensor.
struct Emissions {
  /// Mean emission curves, one of each set of curves that differ in a factor only, up to a factor. Many
  /// lights of one kind then cost as much as one, and do not take wavelengths from other kinds.
  std::vector<Curve> distinct;
  /// Sensor-weighted emission, one per light in the order of `Scene::lights`: the integral of |emission x
  /// response| over wavelength for the channel with the largest one. 0 if the sensor records nothing of the
  /// light.
  std::vector<double> sensor_emissions;
};
/// Emissions of all lights of a scene.
[[nodiscard]] Emissions emissions_of(const Scene& scene);

/// Distributions that guide photons and camera paths; uniform until pilots have trained them.
struct GuidingData {
  /// One per light of the scene if the plan has light tracing, otherwise empty.
  std::vector<PhotonGuide> photon_guides;
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
  const Scene& scene;                  ///< Must outlive the plan.
  WavelengthDistribution wavelengths;  ///< Wavelengths of camera paths, and of light paths of equal packets.
  LightSampler path_lights;            ///< Lights for next-event estimation.
  PowerLightSampler traced_lights;     ///< Lights that emit photons.
  /// True for each light that emits photons. Path tracing leaves the caustics of these to light tracing.
  std::vector<bool> traced;
  GuidingData guides;
  std::vector<Technique> techniques;  ///< Those that own some path, in the order of the enumeration.
  std::uint64_t photons;              ///< Number of photons per sample; at least 1.
  /// A pixel has a camera path in one of this many samples, with this factor as its weight; 1 for all
  /// samples.
  std::uint32_t path_interval;
  double nominal_value;  ///< Film value of a bright pixel, to within a few orders of magnitude.
  /// Wavelengths of camera paths per channel of a mosaic; empty without a mosaic, or if wavelengths of a path
  /// fall on several pixels.
  std::vector<WavelengthDistribution> channel_wavelengths;
  MediumStack camera_media;  ///< Media at the center of the camera at time 0.
  /// Media at each light at time 0, empty for those that emit no photons. The list is empty if no technique
  /// starts paths at lights.
  std::vector<MediumStack> light_media;
  /// True if `camera_media` depends on time, or on the position on a lens or probe: find them for each path.
  bool camera_media_vary = false;
  /// True per light whose `light_media` depend on time: find them for each path. Empty if nothing moves.
  std::vector<bool> light_media_vary = {};
  float gather_radius = 0;  ///< Radius for the first sample [m]; see the function of that name.
  /// Point and spot lights that camera paths connect to along scattering segments.
  PowerLightSampler equiangular_lights{std::vector<double>()};
  /// True if photons of the light tracer split into wavelengths at dispersive glass.
  bool photons_split_wavelengths = false;
  /// Base-2 logarithm of the number of paths into which a camera path splits at its first scattering surface.
  int log2_splits = 0;

  /// Wavelengths of camera paths through the pixel in column x and row y.
  [[nodiscard]] const WavelengthDistribution& wavelengths_at(int x, int y) const {
    return channel_wavelengths.empty()
               ? wavelengths
               : channel_wavelengths[static_cast<std::size_t>(scene.mosaic->at(x, y))];
  }
};

/// Number of photons per sample before techniques are balanced. If `scene_sets_photon_count`, it is
/// `render/photons/per_sample`, by default the number of pixels or 16384, whichever is larger. Otherwise it
/// is the number of pixels.
[[nodiscard]] std::uint64_t photons_of_sample(const Scene& scene);

/// Number of paths per sample that may expose any pixel: photons, or the camera paths of a lens that
/// disperses wavelengths; 0 if each pixel has only its own.
[[nodiscard]] std::uint64_t paths_to_any_pixel(const Plan& plan);

/// Error{scene} if the scene cannot be rendered, nothing otherwise. The causes are:
/// - exposure and lights give film values outside the range of floats;
/// - photons of the integrator cannot start from a light that lies in two media at once: the error names it;
/// - photons of the integrator cannot illuminate the scene: the error names the shape or distant light that
///   is too large or too far.
///
/// Throws Error{resource} if more than `MediumStack::kMaxShapes` media nest at a light.
[[nodiscard]] std::optional<Error> refusal(const Scene& scene);

/// Plan without training, from the scene alone, which must outlive it. Throws the error that `refusal`
/// returns, and Error{resource} if more than `MediumStack::kMaxShapes` media nest at the camera or a light.
[[nodiscard]] Plan make_plan(const Scene& scene);

/// Plan of pilots that trace photons from the lights flagged in `lights`, whatever the scene's integrator.
/// Nothing if none of the lights has power, or if photons cannot start from them or illuminate the scene.
/// `emissions` are those of the scene. Throws Error{resource} as `make_plan`.
[[nodiscard]] std::optional<Plan> make_photon_plan(const Scene& scene, const Emissions& emissions,
                                                   const std::vector<bool>& lights);

}  // namespace abbe
