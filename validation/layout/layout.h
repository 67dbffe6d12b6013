#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "transport/path/ray_trace.h"

namespace abbe {

/// Polyline of a ray for a drawing, in scene coordinates [m].
struct DrawnRay {
  double wavelength_nm;
  std::vector<Imath::V3d> points;
  /// Fraction of the power at the start of the ray; weaker rays are drawn fainter.
  double power_fraction = 1;
};

/// Smallest power fraction of a branch that is drawn.
inline constexpr double kMinDrawnFraction = 1e-3;

/// Polylines of a traced ray, the main branch first. A branch that leaves the scene is extended by the
/// diagonal of the drawn box.
[[nodiscard]] std::vector<DrawnRay> drawn_rays(const Scene& scene, const RayTree& tree, double wavelength_nm);

/// Display colour nearest to the wavelength as "#rrggbb"; grey for invisible wavelengths.
[[nodiscard]] std::string wavelength_color(double wavelength_nm);

/// SVG document with the plan (x, y) and elevation (x, z) of a scene. It shows:
/// - outlines of the shapes that are not distant, with their names;
/// - lights, and the camera with its field of view;
/// - rays in the colours of their wavelengths;
/// - a scale bar in the units of the scene.
[[nodiscard]] std::string layout_drawing(const Scene& scene, const std::vector<DrawnRay>& rays,
                                         const std::string& title);

}  // namespace abbe
