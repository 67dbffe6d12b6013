#pragma once

#include "scene/camera/camera.h"

namespace abbe::test {

// Looking along -y from (1, 2, 3), up is z, so right is -x.
inline CameraFrame frame() {
  return {{1, 2, 3}, {-1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
}

inline Camera narrow_pinhole() {
  return {Pinhole{frame(), 0.05, 0.00625}, 6, 4, 0.005};
}
// The corners of its film are at 75 degrees.
inline Camera wide_pinhole() {
  return {Pinhole{frame(), 0.005, 0.001, 0.7}, 6, 4, 0.005};
}
// Focal length 50 mm in focus at 0.5 m, f/2.
inline Camera lens() {
  return {ThinLens{frame(), 1 / (1 / 0.05 - 1 / 0.5), 0.5, 0.0125}, 6, 4, 0.005};
}
// The same with five blades, and with seven that are turned and a radius of as much light.
inline Camera bladed_lens() {
  return {ThinLens{frame(), 1 / (1 / 0.05 - 1 / 0.5), 0.5, 0.0125, 1, lens::Iris(5, 0)}, 6, 4, 0.005};
}
inline Camera turned_lens() {
  return {ThinLens{frame(), 1 / (1 / 0.05 - 1 / 0.5), 0.5, 0.02, 0.7, lens::Iris(7, 50)}, 6, 4, 0.005};
}
inline Camera wide_lens() {
  return {ThinLens{frame(), 0.006, 0.03, 0.002, 0.7}, 6, 4, 0.005};
}
// The parallelogram meter's pixels are skew.
inline Camera meter() {
  return {Probe{Quad{{1, 1, 1}, {2, 0, 0}, {1, -4, 0}}}, 2, 4, 1};
}
inline Camera disc_meter() {
  return {Probe{Disc{{1, 1, 1}, Imath::V3d(0, 0.6, 0.8), 2}, 0.3}, 2, 4, 1};
}
inline Camera sphere_meter() {
  return {Probe{SphereSide{{{1, 1, 1}, 2}, true}}, 2, 4, 1};
}
inline Camera point_meter() {
  return {Probe{PointOfMeter{{1, 1, 1}, {0, 0, -1}}}, 2, 4, 1};
}

inline const SampledSpectrum kWavelengths(550);

inline CameraRay ray_of(const Camera& camera, Imath::V2f film, Imath::V2f u) {
  return sample_ray(camera, film, u, kWavelengths, 0, 0.25F);
}

}  // namespace abbe::test
