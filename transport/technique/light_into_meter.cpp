#include "transport/path/polarised_ends.h"
#include "transport/technique/light.h"

// Light tracing of what runs into a meter.

namespace abbe {
namespace {

// Where a ray comes into a ball around a meter, or starts within it, whatever its direction: then as far on
// as rays start clear of surfaces, as a way of no length has no direction.
std::optional<CameraConnection> connection_into(const Sphere& ball, const Camera& meter, const Ray& light) {
  const Ray seen = seen_at_rest(meter, light);
  const bool within = (Imath::V3d(seen.origin) - ball.center).length() <= ball.radius;
  const std::optional<double> distance =
      within ? static_cast<double>(offset_length(light.origin)) : crossing(SphereSide{ball}, seen);
  if (!distance) return std::nullopt;
  const Imath::V3f point(Imath::V3d(light.origin) + Imath::V3d(light.direction) * *distance);
  return CameraConnection{{0, 0}, point, 1, SampledSpectrum(1.0F), 1};
}

}  // namespace

std::optional<CameraConnection> LightTracer::into_meter(const LightPath& path) const {
  return ball_ ? connection_into(*ball_, scene_.camera, path.ray)
               : connection_through(scene_.camera, *meter_, path.ray, path.lambda_nm());
}

void LightTracer::run_into_meter(const LightPath& path, int events) {
  const auto lens = into_meter(path);
  if (!lens) return;
  connect_to(path, events, *lens, SampledSpectrum(1.0F), path.ray, path.around,
             seen_on_film(scene_, path.packet, path.ray.direction, path.ray.time, images_of(*lens)));
}

}  // namespace abbe
