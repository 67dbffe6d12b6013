#include "scene/camera/camera.h"

namespace abbe {

CameraRay sample_ray(const Camera& camera, Imath::V2f film, Imath::V2f lens,
                     const SampledSpectrum& wavelengths_nm, int hero, float time) {
  return std::visit(
      [&](const auto& kind) {
        return kind.sample_ray(camera.film(), film, lens, wavelengths_nm, hero, time);
      },
      camera.kind);
}

std::optional<CameraConnection> sample_towards(const Camera& camera, const Imath::V3f& point, Imath::V2f lens,
                                               const SampledSpectrum& wavelengths_nm, float time) {
  return std::visit(
      [&](const auto& kind) { return kind.sample_towards(camera.film(), point, lens, wavelengths_nm, time); },
      camera.kind);
}

std::optional<CameraDensity> density(const Camera& camera, const Ray& ray,
                                     const SampledSpectrum& wavelengths_nm) {
  return std::visit([&](const auto& kind) { return kind.density(camera.film(), ray, wavelengths_nm); },
                    camera.kind);
}

double least_film_cosine(const Camera& camera) {
  return std::visit([&](const auto& kind) { return kind.least_film_cosine(camera.film()); }, camera.kind);
}

CameraTraits traits(const Camera& camera) {
  return std::visit([](const auto& kind) { return kind.traits(); }, camera.kind);
}

const Imath::V3d& position(const Camera& camera) {
  return std::visit([](const auto& kind) -> const Imath::V3d& { return kind.position(); }, camera.kind);
}

Imath::V3d middle(const Camera& camera) {
  return std::visit([](const auto& kind) { return kind.middle(); }, camera.kind);
}

void translate(Camera& camera, const Imath::V3d& by) {
  std::visit([&](auto& kind) { kind.translate(by); }, camera.kind);
}

double central_weight(const Camera& camera, Imath::V2f film) {
  constexpr float kMiddleNm = 550;
  return static_cast<double>(
      sample_ray(camera, film, {0.5F, 0.5F}, SampledSpectrum(kMiddleNm), 0, 0).weight[0]);
}

}  // namespace abbe
