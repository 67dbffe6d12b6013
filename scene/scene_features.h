#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "spectral/curve.h"

namespace abbe {

class Scene;

/// Features of a scene that cost time to render, determined once from the scene alone. The render skips what
/// a false member describes.
struct SceneFeatures {
  bool dispersion = false;  ///< Some refractive index varies with wavelength.
  bool media = false;       ///< Some medium absorbs light.
  bool nesting =
      false;  ///< Media may be nested, or a medium may coincide with another one, a sheet or a wall.
  bool scattering = false;  ///< Some medium scatters light.
  bool boundaries = false;  ///< Some medium begins and ends without an interface.
  bool caustics = false;    ///< A specular surface can focus a light onto a surface that is not specular.
  /// A light is too small to be hit by chance, and one of these holds:
  /// - a camera views its caustics on surfaces that can be connected to the camera;
  /// - it illuminates, through specular surfaces, a probe with an area that photons can hit.
  bool light_tracing = false;
  bool environment = false;
  bool textures = false;  ///< Some BSDF varies over its surface, by texture coordinates or vertex normals.
  bool delta_lights = false;
  bool narrow_bands = false;           ///< Some emission or response has features narrower than 10 nm.
  bool polarisation_relevant = false;  ///< See `polarisation_cause`.
  bool depth_of_field = false;
  bool angular_response = false;  ///< Some filter shifts with the angle of incidence on the film.
  bool motion = false;            ///< A shape, a light or the camera moves while the film is exposed.
  bool encloses_media = false;    ///< Some shape encloses a medium, so that paths may start inside it.
  /// The object that causes each feature which is present, such as 'shape "prism"', by the keys of
  /// `feature_names`.
  std::map<std::string, std::string> reasons = {};
  std::vector<bool> light_is_traced =
      {};  ///< Per light: true if photons sample its caustics because it is small.
};

/// Key of a feature in command output, and its meaning.
struct FeatureName {
  const char* key;
  bool SceneFeatures::*member;
  const char* meaning;
};
[[nodiscard]] std::span<const FeatureName> feature_names();

[[nodiscard]] SceneFeatures analyse(const Scene& scene);

/// True if a curve has a narrow peak: at least a tenth of its maximum, with both half-maximum points less
/// than `width_nm` apart.
[[nodiscard]] bool has_narrow_feature(const Curve& curve, double width_nm = 10);

}  // namespace abbe
