#pragma once

#include <memory>

#include "scene/camera/frame.h"
#include "scene/camera/model.h"

namespace abbe {

struct LensOptics;

/// The film in the plane of the image of a real lens system, whose first vertex is at the frame's position
/// and whose light goes against `forward`.
struct LensSystem {
  CameraFrame frame;
  std::shared_ptr<const LensOptics> optics;
  bool ghosts = false;  ///< Whether light comes by the routes of ghosts too, of which the optics must be.

  [[nodiscard]] CameraRay sample_ray(const FilmGrid& grid, Imath::V2f film, Imath::V2f lens,
                                     const SampledSpectrum& wavelengths_nm, int hero, float time) const;
  [[nodiscard]] std::optional<CameraConnection> sample_towards(const FilmGrid& grid, const Imath::V3f& point,
                                                               Imath::V2f lens,
                                                               const SampledSpectrum& wavelengths_nm,
                                                               float time) const;
  [[nodiscard]] std::optional<CameraDensity> density(const FilmGrid& grid, const Ray& ray,
                                                     const SampledSpectrum& wavelengths_nm,
                                                     LensRoute route) const;
  /// Nothing of a lens without ghosts.
  [[nodiscard]] std::optional<GhostEntrance> sample_ghost(Imath::V2f lens) const;
  [[nodiscard]] double least_film_cosine(const FilmGrid& grid) const;
  [[nodiscard]] CameraTraits traits() const;
  [[nodiscard]] const Imath::V3d& position() const { return frame.position; }
  [[nodiscard]] Imath::V3d middle() const;
  void translate(const Imath::V3d& by) { frame.position += by; }
};
static_assert(CameraModel<LensSystem>);

}  // namespace abbe
