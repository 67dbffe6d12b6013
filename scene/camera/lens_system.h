#pragma once

#include <memory>
#include <optional>

#include "scene/camera/model.h"

namespace abbe {

struct LensOptics;

/// A camera with a real lens system, whose film is in the image plane. The first vertex is at the frame's
/// position, and light propagates against `forward`. Functions without a comment are those of `CameraModel`.
struct LensSystem {
  CameraFrame frame;
  std::shared_ptr<const LensOptics> optics;  ///< Not null; prepared for the film of the camera.
  /// True if rays also take the routes of ghosts; the optics must have them enumerated.
  bool ghosts = false;

  [[nodiscard]] CameraRay sample_ray(const FilmGrid& grid, const CameraSample& sample) const;
  [[nodiscard]] std::optional<CameraConnection> sample_towards(const FilmGrid& grid, const Imath::V3f& point,
                                                               const CameraSample& sample) const;
  [[nodiscard]] std::optional<CameraDensity> density(const FilmGrid& grid, const Ray& ray,
                                                     const SampledSpectrum& wavelengths_nm,
                                                     LensRoute route) const;
  /// Samples the entrance of a ghost at time 0 by two random numbers in [0, 1); nothing if `ghosts` is false.
  [[nodiscard]] std::optional<GhostEntrance> sample_ghost(Imath::V2f lens) const;
  [[nodiscard]] double min_film_cosine(const FilmGrid& grid) const;
  [[nodiscard]] CameraTraits traits() const;
  [[nodiscard]] const Imath::V3d& position() const { return frame.position; }
  /// Center of the entrance pupil, or the first vertex if the pupil lies behind it.
  [[nodiscard]] Imath::V3d center() const;
  void translate(const Imath::V3d& by) { frame.position += by; }
};
static_assert(CameraModel<LensSystem>);

}  // namespace abbe
