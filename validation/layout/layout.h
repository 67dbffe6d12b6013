#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "transport/path/ray_trace.h"

namespace abbe {

/// A ray's way for a drawing, in the scene's own coordinates [m].
struct DrawnRay {
  double wavelength_nm;
  std::vector<Imath::V3d> points;
  double share = 1;  ///< Of the power, at its start: the less, the fainter it is drawn.
};

/// Branches of less power are not drawn.
inline constexpr double kLeastDrawnShare = 1e-3;

/// The ways of a ray that was followed, the main branch first; one that leaves the scene is drawn on as far
/// again as the scene is large.
[[nodiscard]] std::vector<DrawnRay> drawn_rays(const Scene& scene, const RayTree& tree, double wavelength_nm);

/// The colour of a wavelength as displays come nearest to it; grey where nobody sees it.
[[nodiscard]] std::string wavelength_color(double wavelength_nm);

/// Plan (x, y) and elevation (x, z) of a scene as one SVG: outlines of what is near with their names, lamps,
/// the camera with its field, rays in the colours of their wavelengths, and a bar of scale in the scene's
/// units.
[[nodiscard]] std::string layout_drawing(const Scene& scene, const std::vector<DrawnRay>& rays,
                                         const std::string& title);

}  // namespace abbe
