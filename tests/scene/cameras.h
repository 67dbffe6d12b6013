#pragma once

#include "scene/camera/camera.h"

namespace abbe::test {

// A frame at (1, 2, 3) that looks along -y with z up, so that right is -x.
inline CameraFrame frame() {
  return {{1, 2, 3}, {-1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
}

inline Camera narrow_pinhole() {
  return {Pinhole{frame(), 0.05, 0.00625}, 6, 4, 0.005};
}
// A pinhole with the corners of its film at 75 degrees.
inline Camera wide_pinhole() {
  return {Pinhole{frame(), 0.005, 0.001, 0.7}, 6, 4, 0.005};
}
// A thin lens of 50 mm focal length, in focus at 0.5 m, at f/2.
inline Camera lens() {
  return {ThinLens{frame(), 1 / (1 / 0.05 - 1 / 0.5), 0.5, 0.0125}, 6, 4, 0.005};
}
// That lens with five blades, and with seven rotated blades and a radius that transmits as much light.
inline Camera bladed_lens() {
  return {ThinLens{frame(), 1 / (1 / 0.05 - 1 / 0.5), 0.5, 0.0125, 1, lens::Iris(5, 0)}, 6, 4, 0.005};
}
inline Camera turned_lens() {
  return {ThinLens{frame(), 1 / (1 / 0.05 - 1 / 0.5), 0.5, 0.02, 0.7, lens::Iris(7, 50)}, 6, 4, 0.005};
}
inline Camera wide_lens() {
  return {ThinLens{frame(), 0.006, 0.03, 0.002, 0.7}, 6, 4, 0.005};
}
// A probe on a parallelogram, whose pixels are skew.
inline Camera meter() {
  return {IrradianceProbe{Quad{{1, 1, 1}, {2, 0, 0}, {1, -4, 0}}}, 2, 4, 1};
}
inline Camera disc_meter() {
  return {IrradianceProbe{Disc{{1, 1, 1}, Imath::V3d(0, 0.6, 0.8), 2}, 0.3}, 2, 4, 1};
}
inline Camera sphere_meter() {
  return {IrradianceProbe{SphereSide{{{1, 1, 1}, 2}, true}}, 2, 4, 1};
}
inline Camera point_meter() {
  return {IrradianceProbe{ProbePoint{{1, 1, 1}, {0, 0, -1}}}, 2, 4, 1};
}

inline const SampledSpectrum kWavelengths(550);

inline CameraRay ray_of(const Camera& camera, Imath::V2f film, Imath::V2f u) {
  return sample_ray(camera, film, u, kWavelengths, 0, 0.25F);
}

}  // namespace abbe::test
