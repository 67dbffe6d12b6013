#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace abbe {

/// A ray's way for a drawing, in the scene's own coordinates [m].
struct DrawnRay {
  double wavelength_nm;
  std::vector<Imath::V3d> points;
};

/// Follows a ray (`trace_ray`); one that leaves the scene is drawn on as far again as the scene is large.
[[nodiscard]] DrawnRay drawn_ray(const Scene& scene, const BasicRay<double>& ray, double wavelength_nm,
                                 int max_events);

/// The colour of a wavelength as displays come nearest to it; grey where nobody sees it.
[[nodiscard]] std::string wavelength_color(double wavelength_nm);

/// Plan (x, y) and elevation (x, z) of a scene as one SVG: outlines of what is near with their names, lamps,
/// the camera with its field, rays in the colours of their wavelengths, and a bar of scale in the scene's
/// units.
[[nodiscard]] std::string layout_drawing(const Scene& scene, const std::vector<DrawnRay>& rays,
                                         const std::string& title);

}  // namespace abbe
