#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace abbe {

class Scene;

/// Features of a scene that cost time to render, determined once from the scene alone. The render skips what
/// a false member describes.
struct SceneFeatures {
  bool dispersion = false;  ///< Some refractive index varies with wavelength.
  bool media = false;       ///< Some medium absorbs light.
  /// Media may be nested, or a medium may coincide with another one, a sheet or a wall.
  bool nesting = false;
  bool scattering = false;  ///< Some medium scatters light.
  bool boundaries = false;  ///< Some medium begins and ends without an interface.
  bool caustics = false;    ///< A specular surface can focus a light onto a surface that is not specular.
  /// A light is too small to be hit by chance, and one of these holds:
  /// - a camera views its caustics on surfaces that can be connected to the camera;
  /// - it illuminates, through specular surfaces, a probe with an area that photons can hit.
  bool light_tracing = false;
  bool environment =
      false;              ///< Some environment light exists: light arrives from infinity in all directions.
  bool textures = false;  ///< Some BSDF needs texture coordinates, or some mesh has vertex normals.
  bool delta_lights = false;  ///< Some light is a point, spot or directional light.
  /// Polarisation affects the power of some path: one event polarises light, and a later one or the camera
  /// depends on polarisation.
  bool polarisation_relevant = false;
  bool depth_of_field = false;    ///< The camera has an opening of finite size; false for probes.
  bool angular_response = false;  ///< Some filter shifts with the angle of incidence on the film.
  bool motion = false;            ///< A shape, a light or the camera moves while the film is exposed.
  bool encloses_media = false;    ///< Some shape encloses a medium, so that paths may start inside it.
  /// The first object that causes each feature which is present, such as 'shape "prism"', by the keys of
  /// `feature_names`. There is none for `encloses_media`.
  std::map<std::string, std::string> reasons = {};
  /// True for each light, by its index in `Scene::lights`, whose caustics photons sample for one of the
  /// reasons of `light_tracing`.
  std::vector<bool> light_is_traced = {};
};

/// Key of a feature in command output, and its meaning.
struct FeatureName {
  const char* key;
  bool SceneFeatures::*member;
  const char* meaning;  ///< English clause or noun phrase that describes the cause.
};
/// Names of all features except `encloses_media`, in a fixed order.
[[nodiscard]] std::span<const FeatureName> feature_names();

/// Determines the features of a scene whose bounds and volumes are known; `Scene::commit` calls it. Never
/// throws.
[[nodiscard]] SceneFeatures analyse(const Scene& scene);

/// True if paths of the scene carry polarisation: `features.polarisation_relevant`, and the render settings
/// do not turn it off. Requires `Scene::commit`.
[[nodiscard]] bool carries_polarisation(const Scene& scene);

}  // namespace abbe
