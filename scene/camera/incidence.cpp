#include "scene/camera/incidence.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace abbe {
namespace {

constexpr std::uint32_t kRays = 4096;
constexpr std::size_t kGroups = 32;  // groups of rays with similar angles
constexpr double kSameSine2 = 1e-9;  // smaller differences count as one angle
constexpr float kReferenceNm = 550;

// Squared sine of a ray's angle of incidence, on which filter shifts depend, and its irradiance.
struct WeightedAngle {
  double sine2;
  double weight;
};

// Point i of Hammersley's set of `kRays` points in the unit square: (i + 1/2)/kRays, and the radical inverse
// of i in base 2 [Pharr2023, sec. 8.6].
Imath::V2f hammersley(std::uint32_t i) {
  float mirrored = 0.5F / kRays;
  float digit = 0.5F;
  for (std::uint32_t rest = i; rest > 0; rest /= 2, digit /= 2)
    if (rest % 2 == 1) mirrored += digit;
  return {(static_cast<float>(i) + 0.5F) / kRays, mirrored};
}

std::vector<WeightedAngle> angles_over_lens(const Camera& camera, Imath::V2f film) {
  const Camera image_camera = without_ghosts(camera);
  std::vector<WeightedAngle> angles;
  for (std::uint32_t i = 0; i < kRays; ++i) {
    const CameraRay ray = sample_ray(image_camera, film, hammersley(i), SampledSpectrum(kReferenceNm), 0, 0);
    const auto weight = static_cast<double>(ray.weight[0]);
    const auto cos_film = static_cast<double>(ray.cos_film);
    if (weight > 0) angles.push_back({(1 - cos_film) * (1 + cos_film), weight});
  }
  return angles;
}

}  // namespace

std::vector<Incidence> incidence_angles(const Camera& camera, Imath::V2f film) {
  std::vector<WeightedAngle> rays = angles_over_lens(camera, film);
  if (rays.empty()) return {};
  std::sort(rays.begin(), rays.end(),
            [](const WeightedAngle& a, const WeightedAngle& b) { return a.sine2 < b.sine2; });
  const bool is_single_angle = rays.back().sine2 - rays.front().sine2 < kSameSine2;
  const std::size_t groups = is_single_angle ? 1 : std::min(kGroups, rays.size());
  std::vector<Incidence> angles;
  double total_weight = 0;
  for (std::size_t group = 0; group < groups; ++group) {
    double weight = 0;
    double sine2 = 0;
    for (std::size_t i = group * rays.size() / groups; i < (group + 1) * rays.size() / groups; ++i) {
      weight += rays[i].weight;
      sine2 += rays[i].weight * rays[i].sine2;
    }
    angles.push_back({std::sqrt(1 - sine2 / weight), weight});
    total_weight += weight;
  }
  for (Incidence& angle : angles) angle.fraction /= total_weight;
  return angles;
}

}  // namespace abbe
