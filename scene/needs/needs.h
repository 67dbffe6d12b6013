#pragma once

#include <string>
#include <vector>

#include "spectral/curve.h"

namespace abbe {

class Scene;

/// What a scene contains that costs time; decided once, from the scene alone. What is false is skipped.
struct Needs {
  bool dispersion = false;  ///< Some refractive index varies with wavelength.
  bool media = false;       ///< Some matter absorbs along the path.
  bool caustics = false;    ///< A specular surface can focus a light onto a surface that is not specular.
  bool light_tracing =
      false;  ///< Caustics, a camera that can be connected to, and a light too small to be hit by chance.
  bool environment = false;
  bool delta_lights = false;
  bool narrow_bands = false;  ///< Some emission or response has features narrower than 10 nm.
  bool polarisation_matters =
      false;  ///< Two or more dielectric or metal events may follow each other off-normal.
  bool depth_of_field = false;
  std::vector<bool> light_is_traced = {};  ///< Per light: so small that its caustics are the light tracer's.
};

[[nodiscard]] Needs analyse(const Scene& scene);

/// Whether a curve rises to a peak of at least a tenth of its maximum and falls below half that peak on both
/// sides within less than `width_nm`.
[[nodiscard]] bool has_narrow_feature(const Curve& curve, double width_nm = 10);

/// One class of paths that no active technique reaches: a regular expression from the eye E to the light L
/// over specular (S) and diffuse (D) vertices, and what it is in words [Heckbert1990].
using PathClass = std::string;

/// `light_tracing_active`: whether photons are traced from the lights of `needs.light_is_traced`. With
/// Integrator::light nothing else is.
[[nodiscard]] std::vector<PathClass> unreached(const Scene& scene, const Needs& needs,
                                               bool light_tracing_active);

}  // namespace abbe
