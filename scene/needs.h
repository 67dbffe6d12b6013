#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "spectral/curve.h"

namespace abbe {

class Scene;

/// What a scene contains that costs time; decided once, from the scene alone. What is false is skipped.
struct Needs {
  bool dispersion = false;  ///< Some refractive index varies with wavelength.
  bool media = false;       ///< Some matter absorbs along the path.
  bool nesting = false;     ///< Matter may be within other matter, or touch it.
  bool scattering = false;  ///< Some matter scatters light within.
  bool boundaries = false;  ///< Some matter begins and ends without an interface.
  bool caustics = false;    ///< A specular surface can focus a light onto a surface that is not specular.
  /// A light too small to be hit by chance, and caustics of it that a camera sees which can be connected to,
  /// or specular surfaces through which it lights a meter that photons can run into.
  bool light_tracing = false;
  bool environment = false;
  bool textures =
      false;  ///< Some scattering depends on where on its surface: by coordinates or vertex normals.
  bool delta_lights = false;
  bool narrow_bands = false;          ///< Some emission or response has features narrower than 10 nm.
  bool polarisation_matters = false;  ///< See `polarisation_need`.
  bool depth_of_field = false;
  bool angular_response = false;  ///< Some filter shifts with the angle of incidence on the film.
  bool motion = false;            ///< A shape, a light or the camera moves while the film is exposed.
  bool matter = false;            ///< A shape holds matter, in which paths may start.
  /// By the names of `need_names`: what in the scene asks for a need that holds, as 'shape "prism"'.
  std::map<std::string, std::string> because = {};
  std::vector<bool> light_is_traced = {};  ///< Per light: so small that its caustics are the light tracer's.
};

/// What a need is called in answers, and what it means.
struct NeedName {
  const char* key;
  bool Needs::*member;
  const char* meaning;
};
[[nodiscard]] std::span<const NeedName> need_names();

[[nodiscard]] Needs analyse(const Scene& scene);

/// Whether a curve rises to a peak of at least a tenth of its maximum and falls below half that peak on both
/// sides within less than `width_nm`.
[[nodiscard]] bool has_narrow_feature(const Curve& curve, double width_nm = 10);

}  // namespace abbe
