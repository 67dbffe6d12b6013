#include "transport/path/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "transport/path/medium.h"
#include "transport/path/packet.h"
#include "transport/path/vertex.h"

namespace abbe {
namespace {

// Groups of random numbers: the film position shares its group with the wavelength, since a spectrum on the
// film is a function of both.
constexpr std::uint32_t kFilmGroup = 0;
constexpr std::uint32_t kLensGroup = 1;  // its third number is kept for the time within the exposure
constexpr int kMeterDepth = -1;          // a meter scatters before the first surface does
constexpr std::uint32_t scatter_group(int depth) {
  return 2 + 2 * static_cast<std::uint32_t>(depth - kMeterDepth);
}
constexpr std::uint32_t light_group(int depth) {
  return 1 + scatter_group(depth);
}

class CameraPath {
 public:
  CameraPath(const Plan& plan, RayCaster& caster, const Sampler& sampler,
             const SampledWavelengths& wavelengths, const CameraRay& start, PathExposure& exposure)
      : plan_(plan),
        scene_(plan.scene),
        caster_(caster),
        sampler_(sampler),
        exposure_(exposure),
        ray_(start.ray),
        inside_(plan.camera_inside) {
    packet_.wavelengths = wavelengths;
    if (!inside_.empty()) medium_ = medium_within(scene_, inside_, lambda());
    exposure_.begin(wavelengths, start.weight * static_cast<float>(scene_.exposure_s));
  }

  /// At a meter: adds what lights it directly. Whether a ray is left to find the rest.
  bool leave_meter(const Imath::V3f& point, const Imath::V3f& normal) {
    const bool leaves = scatter(Vertex::meter(point, normal), kMeterDepth);
    exposure_.at_angle(ray_.direction.dot(normal));
    return leaves;
  }

  void trace() {
    for (int depth = 0;; ++depth) {
      std::optional<SurfaceHit> hit = caster_.intersect(ray_);
      if (!hit) {
        add_environment();
        return;
      }
      medium_.attenuate(packet_.throughput, hit->t);
      if (scene_.needs.nesting) {
        interface_ = interface_at(scene_, ray_, *hit, inside_);
        hit = interface_->hit;
      }
      add_emission(*hit, depth);
      if (depth >= scene_.render.max_depth) return;
      const Vertex vertex = interface_ ? Vertex(scene_, *interface_, ray_.direction, lambda())
                                       : Vertex(scene_, *hit, ray_.direction, lambda());
      if (is_black(vertex.bsdf)) return;
      if (!scatter(vertex, depth)) return;
    }
  }

 private:
  [[nodiscard]] const SampledSpectrum& lambda() const { return packet_.wavelengths.lambda_nm; }

  // Sum over lanes and techniques of the densities that could have made the path now ending on a light,
  // relative to the hero's by scattering. `light_pdf` is that of light sampling from the previous vertex.
  [[nodiscard]] float balance(float light_pdf) const {
    return packet_.lane_pdf.sum() + light_pdf * light_sampling_lanes_;
  }

  void add_environment() {
    const std::int32_t index = scene_.environment();
    if (index < 0) return;
    const Light& light = scene_.lights[static_cast<std::size_t>(index)];
    medium_.attenuate(packet_.throughput, std::numeric_limits<float>::infinity());
    const float pdf =
        !light_sampled_before_
            ? 0.0F
            : plan_.path_lights.probability(static_cast<std::uint32_t>(index)) *
                  light_pdf(light, scene_.shapes, ray_.origin, ray_.direction, Imath::V3f(0), Imath::V3f(0));
    exposure_.deposit(packet_.throughput * emission_from(light, ray_.direction, lambda()) *
                      (1 / balance(pdf)));
  }

  void add_emission(const SurfaceHit& hit, int depth) {
    const std::int32_t index = scene_.shapes[hit.shape].light;
    if (index < 0) return;
    const auto light_index = static_cast<std::uint32_t>(index);
    const Light& light = scene_.lights[light_index];
    if (!emits_towards(light, hit.normal, -ray_.direction)) return;
    if (depth > 0 && !light_sampled_before_ && !first_specular_ && plan_.traced[light_index]) return;
    const float pdf = !light_sampled_before_ ? 0.0F
                                             : plan_.path_lights.probability(light_index) *
                                                   light_pdf(light, scene_.shapes, ray_.origin,
                                                             ray_.direction, hit.point, hit.normal);
    exposure_.deposit(packet_.throughput * light.emission(lambda()) * (1 / balance(pdf)));
  }

  // In line in the loop of `trace`: left to itself the compiler makes it a call, for the meter's sake, which
  // costs every path more than all else it does not need.
  [[gnu::always_inline]] bool scatter(const Vertex& vertex, int depth) {
    if (scatters(vertex.bsdf)) add_direct(vertex, depth);
    const std::array<float, 4> u = sampler_.group(scatter_group(depth));
    const std::optional<BsdfSample> sampled = vertex.scatter({u[2], {u[0], u[1]}}, TransportMode::radiance);
    if (!sampled) return false;
    if (depth == 0) first_specular_ = sampled->delta;
    follow(vertex, *sampled);
    return survives(depth, u[3]);
  }

  void follow(const Vertex& vertex, const BsdfSample& event) {
    light_sampling_lanes_ = event.delta ? 0.0F : packet_.lane_pdf.sum() / event.pdf;
    light_sampled_before_ = !event.delta;
    packet_.throughput *= event.weight;
    packet_.lane_pdf *= event.lane_pdf;
    const Imath::V3f direction = vertex.frame.to_world(event.wi);
    if (event.transmitted) {
      inside_ = vertex.behind(scene_, inside_);
      medium_ = medium_within(scene_, inside_, lambda());
      const float n = index_inside(vertex.bsdf, kHero);
      eta_scale_ *= vertex.wo.z > 0 ? n * n : 1 / (n * n);
    }
    ray_ = spawn(vertex.hit, direction);
  }

  bool survives(int depth, float u) {
    if (packet_.throughput.is_zero()) return false;
    if (scene_.render.roulette_depth < 0 || depth + 1 < scene_.render.roulette_depth) return true;
    const float q = survival(packet_, eta_scale_);
    if (u >= q) return false;
    packet_.throughput *= 1 / q;
    return true;
  }

  void add_direct(const Vertex& vertex, int depth) {
    if (plan_.path_lights.empty()) return;
    const std::array<float, 4> u = sampler_.group(light_group(depth));
    const LightPicker::Pick pick = plan_.path_lights.pick(u[0]);
    const Light& light = scene_.lights[pick.light];
    const std::optional<LightSample> towards =
        sample_light(light, scene_.shapes, vertex.hit.point, {u[1], u[2]});
    if (!towards) return;
    const Imath::V3f wi = vertex.frame.to_local(towards->wi);
    SampledSpectrum contribution = vertex.towards(towards->wi, wi, TransportMode::radiance);
    if (contribution.is_zero()) return;
    contribution *=
        packet_.throughput * emission_from(light, towards->wi, lambda()) * (std::abs(wi.z) * towards->factor);
    const float light_density = pick.probability * towards->pdf;
    const SampledSpectrum scatter_density =
        light.is_delta() ? SampledSpectrum(0.0F) : pdf(vertex.bsdf, vertex.wo, wi);
    const float balance = (packet_.lane_pdf * (SampledSpectrum(light_density) + scatter_density)).sum();
    if (!(balance > 0) || blocked(vertex, *towards)) return;
    side_of(vertex, wi).attenuate(contribution, towards->distance);
    if (depth == kMeterDepth) exposure_.at_angle(wi.z);
    exposure_.deposit(contribution * (1 / balance));
  }

  // The medium that light from the local direction `wi` comes through.
  [[nodiscard]] Medium side_of(const Vertex& vertex, const Imath::V3f& wi) const {
    if (wi.z * vertex.wo.z > 0) return medium_;
    return medium_within(scene_, vertex.behind(scene_, inside_), lambda());
  }

  [[nodiscard]] bool blocked(const Vertex& vertex, const LightSample& towards) {
    const Ray ray = spawn(vertex.hit, towards.wi);
    return std::isfinite(towards.distance) ? caster_.occluded(ray.origin, towards.end)
                                           : caster_.occluded(ray);
  }

  const Plan& plan_;
  const Scene& scene_;
  RayCaster& caster_;
  const Sampler& sampler_;
  PathExposure& exposure_;
  Ray ray_;
  PathPacket packet_;
  Enclosures inside_;
  Medium medium_;                       // within them
  std::optional<Interface> interface_;  // met last, where matter may be nested
  float eta_scale_ = 1;
  // Sum of lane densities before the last scattering over the hero's density of it: what a unit of
  // light-sampling density weighs.
  float light_sampling_lanes_ = 0;
  bool light_sampled_before_ = false;
  bool first_specular_ = false;
};

}  // namespace

void trace_camera_path(const Plan& plan, RayCaster& caster, const Sampler& sampler, int x, int y,
                       PathExposure& exposure) {
  const std::array<float, 4> film = sampler.group(kFilmGroup);
  const Camera& camera = plan.scene.camera;
  const std::array<float, 4> lens = camera.is_pinhole() ? std::array<float, 4>{} : sampler.group(kLensGroup);
  const Imath::V2f position(static_cast<float>(x) + film[0], static_cast<float>(y) + film[1]);
  const CameraRay start = sample_ray(camera, position, {lens[0], lens[1]});
  const SampledWavelengths wavelengths = plan.wavelengths_at(x, y).sample(film[2]);
  CameraPath path(plan, caster, sampler, wavelengths, start, exposure);
  exposure.at_pixel(x, y);
  exposure.at_angle(start.cos_film);
  const auto* meter = std::get_if<IrradianceProbe>(&camera.kind);
  if (meter == nullptr || path.leave_meter(start.ray.origin, Imath::V3f(meter->normal))) path.trace();
}

}  // namespace abbe
