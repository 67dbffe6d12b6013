#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "transport/path/ray_trace.h"

namespace abbe {

/// Polyline of a ray for a drawing, in render coordinates [m].
struct DrawnRay {
  double wavelength_nm;
  std::vector<Imath::V3d> points;  ///< From the start of the ray, in order along it.
  /// Fraction of the power at the start of the ray; weaker rays are drawn fainter.
  double power_fraction = 1;
};

/// Power fraction below which a ray is not followed for a drawing. Rays of this power are drawn faintest.
inline constexpr double kMinDrawnFraction = 1e-3;

/// Polylines of all branches of a ray that was traced at that wavelength, in the order of `tree`. A branch
/// that leaves the scene is extended by the diagonal of the drawn box. Branches are not filtered by power.
[[nodiscard]] std::vector<DrawnRay> drawn_rays(const Scene& scene, const RayTree& tree, double wavelength_nm);

/// Brightest display colour near that of the wavelength, as "#rrggbb" in sRGB; grey for invisible
/// wavelengths.
[[nodiscard]] std::string wavelength_color(double wavelength_nm);

/// SVG document with the plan (x, y) and elevation (x, z) of a committed scene at time 0. It shows the shapes
/// and lights that are not distant, at most 60 names, the camera with its field of view, and rays in the
/// colours of their wavelengths. The scale bar has the units of the scene.
[[nodiscard]] std::string layout_drawing(const Scene& scene, const std::vector<DrawnRay>& rays,
                                         const std::string& title);

}  // namespace abbe
