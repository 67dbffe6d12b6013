#include "transport/path/polarised_ends.h"
#include "transport/technique/light.h"

// Light tracing: photons that hit a probe.

namespace abbe {
namespace {

// Connection of a ray that enters a ball around a probe or starts within it, whatever its direction. Within
// the ball the point is one offset length away, because a segment of length 0 has no direction.
std::optional<CameraConnection> connection_into(const Sphere& ball, const Camera& meter, const Ray& light) {
  const Ray at_rest = ray_in_rest_frame(meter, light);
  const bool within = (Imath::V3d(at_rest.origin) - ball.center).length() <= ball.radius;
  const std::optional<double> distance =
      within ? static_cast<double>(offset_length(light.origin)) : crossing(SphereSide{ball}, at_rest);
  if (!distance) return std::nullopt;
  const Imath::V3f point(Imath::V3d(light.origin) + Imath::V3d(light.direction) * *distance);
  return CameraConnection{{0, 0}, point, 1, SampledSpectrum(1.0F), 1};
}

}  // namespace

std::optional<CameraConnection> LightTracer::probe_connection(const LightPath& path) const {
  return ball_ ? connection_into(*ball_, scene_.camera, path.ray)
               : connection_through(scene_.camera, *probe_opening_, path.ray, path.lambda_nm());
}

void LightTracer::record_probe_hit(const LightPath& path, int depth) {
  const auto lens = probe_connection(path);
  if (!lens) return;
  connect_to(path, depth, *lens, SampledSpectrum(1.0F), path.ray, path.media,
             measured_on_film(scene_, path.packet, path.ray.direction, path.ray.time, images_of(*lens)));
}

}  // namespace abbe
