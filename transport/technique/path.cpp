#include "transport/technique/path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "transport/path/free_path.h"
#include "transport/path/packet.h"
#include "transport/path/roulette.h"
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

constexpr std::uint32_t free_path_group(int depth) {
  return 0x80000000 + static_cast<std::uint32_t>(depth);
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
        end_{start.ray, {}, plan.camera_inside, {}},
        has_free_paths_(has_free_paths(scene_)),
        most_events_(most_events(scene_.render)) {
    end_.packet.wavelengths = wavelengths;
    if (!end_.inside.empty()) end_.medium = medium_within(scene_, end_.inside, lambda());
    exposure_.begin(wavelengths, start.weight * static_cast<float>(scene_.exposure_s));
  }

  /// At a meter: adds what lights it directly. Whether a ray is left to find the rest.
  bool leave_meter(const Imath::V3f& point, const Imath::V3f& normal) {
    const bool leaves = scatter(Vertex::meter(point, normal), kMeterDepth);
    exposure_.at_angle(end_.ray.direction.dot(normal));
    return leaves;
  }

  void trace() {
    for (int depth = 0;; ++depth) {
      std::optional<SurfaceHit> hit = caster_.intersect(end_.ray);
      if (has_free_paths_) {
        if (scatters_before(hit, depth)) {
          if (is_cut(depth) || !scatter_within(depth)) return;
          continue;
        }
      } else if (hit) {
        end_.medium.attenuate(end_.packet.throughput, hit->t);
      }
      if (!hit) {
        add_background(depth);
        return;
      }
      if (scene_.needs.nesting) {
        interface_ = interface_at(scene_, end_.ray, *hit, end_.inside);
        hit = interface_->hit;
      }
      add_emission(*hit, depth);
      const Vertex vertex = interface_ ? Vertex(scene_, *interface_, end_.ray.direction, lambda())
                                       : Vertex(scene_, *hit, end_.ray.direction, lambda());
      if (is_black(vertex.bsdf) || is_cut(depth)) return;
      if (!scatter(vertex, depth)) return;
    }
  }

 private:
  [[nodiscard]] const SampledSpectrum& lambda() const { return end_.packet.wavelengths.lambda_nm; }

  // The throughput that decides about roulette: what refraction into glass takes off radiance counts as still
  // there.
  [[nodiscard]] float carried() const { return end_.packet.carried() * eta_scale_; }

  // Whether the path may not have the event number `depth`, counted from 0.
  bool is_cut(int depth) {
    if (depth < most_events_) return false;
    caster_.count_cut(carried());
    return true;
  }

  // Sum over lanes and techniques of the densities that could have made the path now ending on a light,
  // relative to the hero's by scattering. `light_pdf` is that of light sampling from the previous vertex.
  [[nodiscard]] float balance(float light_pdf) const {
    return end_.packet.lane_pdf.sum() + light_pdf * light_sampling_lanes_;
  }

  // Whether photons bring what a light met after `depth` events sends along this path.
  [[nodiscard]] bool owned_by_photons(std::uint32_t light, int depth) const {
    return depth > 0 && !light_sampled_before_ && !first_specular_ && plan_.traced[light];
  }

  // With which light sampling chose the light where the path scattered last.
  [[nodiscard]] float light_probability(std::uint32_t light) const {
    return plan_.path_lights.probability(light, place_.point, place_.normal());
  }

  void add_background(int depth) {
    if (scene_.background().empty()) return;
    end_.medium.attenuate(end_.packet.throughput, std::numeric_limits<float>::infinity());
    for (const std::uint32_t index : scene_.background()) {
      const Light& light = scene_.lights[index];
      const auto* sun = std::get_if<SunLight>(&light.kind);
      if ((sun != nullptr && !sun->shows(end_.ray.direction)) || owned_by_photons(index, depth)) continue;
      const float pdf =
          !light_sampled_before_
              ? 0.0F
              : light_probability(index) * light_pdf(light, scene_.shapes, end_.ray.origin,
                                                     end_.ray.direction, Imath::V3f(0), Imath::V3f(0));
      exposure_.deposit(
          end_.packet.throughput * emission_from(light, end_.ray.direction, lambda()) * (1 / balance(pdf)),
          index);
    }
  }

  void add_emission(const SurfaceHit& hit, int depth) {
    const std::int32_t index = scene_.shapes[hit.shape].light;
    if (index < 0) return;
    const auto light_index = static_cast<std::uint32_t>(index);
    const Light& light = scene_.lights[light_index];
    if (!emits_towards(light, hit.normal, -end_.ray.direction)) return;
    if (owned_by_photons(light_index, depth)) return;
    const float pdf = !light_sampled_before_ ? 0.0F
                                             : light_probability(light_index) *
                                                   light_pdf(light, scene_.shapes, end_.ray.origin,
                                                             end_.ray.direction, hit.point, hit.normal);
    exposure_.deposit(end_.packet.throughput * light.emission(lambda()) * (1 / balance(pdf)), light_index);
  }

  // In line in the loop of `trace`: left to itself the compiler makes it a call, for the meter's sake, which
  // costs every path more than all else it does not need.
  [[gnu::always_inline]] bool scatter(const Vertex& vertex, int depth) {
    place_.point = vertex.hit.point;
    if (plan_.path_lights.asks_for_places()) place_.side = vertex.lit_side();
    if (scatters(vertex.bsdf)) add_direct(vertex, depth);
    const std::array<float, 4> u = sampler_.group(scatter_group(depth));
    const std::optional<BsdfSample> sampled = vertex.scatter({u[2], {u[0], u[1]}}, TransportMode::radiance);
    if (!sampled) return false;
    if (depth == 0) first_specular_ = sampled->delta;
    follow(vertex, *sampled);
    return survives(depth, u[3]);
  }

  void follow(const Vertex& vertex, const BsdfSample& event) {
    light_sampling_lanes_ = event.delta ? 0.0F : end_.packet.lane_pdf.sum() / event.pdf;
    light_sampled_before_ = !event.delta;
    end_.packet.throughput *= event.weight;
    end_.packet.lane_pdf *= event.lane_pdf;
    const Imath::V3f direction = vertex.frame.to_world(event.wi);
    if (event.transmitted) {
      end_.enter(scene_, vertex.behind(scene_, end_.inside));
      const float n = index_inside(vertex.bsdf, kHero);
      eta_scale_ *= vertex.wo.z > 0 ? n * n : 1 / (n * n);
    }
    end_.ray = spawn(vertex.hit, direction);
  }

  bool survives(int depth, float u) {
    if (end_.packet.throughput.is_zero()) return false;
    if (!plays_roulette(scene_.render, depth + 1)) return true;
    const float q = survival(carried(), depth + 1);
    if (u >= q) return false;
    end_.packet.throughput *= 1 / q;
    return true;
  }

  // Flies to the next event: whether that is in matter, before the surface `hit`.
  [[gnu::noinline]] bool scatters_before(std::optional<SurfaceHit>& hit, int depth) {
    const std::array<float, 4> u = sampler_.group(free_path_group(depth));
    const FreePath free_path = propagate(scene_, caster_, {u[0], u[1]}, end_, hit);
    light_sampling_lanes_ *= free_path.density_scale;
    return free_path.scattered;
  }

  [[gnu::noinline]] bool scatter_within(int depth) {
    const PhaseFunction& phase = end_.medium.scattering->phase;
    place_ = {end_.ray.origin, {}};
    add_direct_within(phase, depth);
    const std::array<float, 4> u = sampler_.group(scatter_group(depth));
    const PhaseSample turned = sample(phase, {u[0], u[1]});
    light_sampling_lanes_ = end_.packet.lane_pdf.sum() / turned.pdf;
    light_sampled_before_ = true;
    end_.ray.direction = Basis<float>(end_.ray.direction).to_world(turned.direction);
    return survives(depth, u[3]);
  }

  // A light, a direction towards it from a point, and the density of both.
  struct Lit {
    std::uint32_t index;
    const Light& light;
    LightSample towards;
    float density;
  };
  [[nodiscard]] std::optional<Lit> pick_light(int depth) const {
    if (plan_.path_lights.empty()) return std::nullopt;
    const std::array<float, 4> u = sampler_.group(light_group(depth));
    const LightPicker::Pick pick = plan_.path_lights.pick(place_.point, place_.normal(), u[0]);
    const Light& light = scene_.lights[pick.light];
    const std::optional<LightSample> towards = sample_light(light, scene_.shapes, place_.point, {u[1], u[2]});
    if (!towards) return std::nullopt;
    return Lit{pick.light, light, *towards, pick.probability * towards->pdf};
  }

  // What comes from the light on an unobstructed way and is turned towards the path, `scattered` being the
  // share of it.
  [[nodiscard]] SampledSpectrum turned_light(const Lit& lit, const SampledSpectrum& scattered,
                                             float cosine) const {
    return scattered * (end_.packet.throughput * emission_from(lit.light, lit.towards.wi, lambda()) *
                        (cosine * lit.towards.factor));
  }

  void add_direct(const Vertex& vertex, int depth) {
    const std::optional<Lit> lit = pick_light(depth);
    if (!lit) return;
    const Imath::V3f wi = vertex.frame.to_local(lit->towards.wi);
    const SampledSpectrum scattered = vertex.towards(lit->towards.wi, wi, TransportMode::radiance);
    if (scattered.is_zero()) return;
    SampledSpectrum contribution = turned_light(*lit, scattered, std::abs(wi.z));
    const SampledSpectrum density =
        lit->light.is_delta() ? SampledSpectrum(0.0F) : pdf(vertex.bsdf, vertex.wo, wi);
    const Ray ray = spawn(vertex.hit, lit->towards.wi);
    if (depth == kMeterDepth) exposure_.at_angle(wi.z);
    if (has_free_paths_) {
      add_through_media(*lit, contribution, density, leaving(scene_, end_, vertex, wi, ray));
      return;
    }
    const float balance = (end_.packet.lane_pdf * (SampledSpectrum(lit->density) + density)).sum();
    if (!(balance > 0) || blocked(ray, lit->towards)) return;
    side_of(vertex, wi).attenuate(contribution, lit->towards.distance);
    exposure_.deposit(contribution * (1 / balance), lit->index);
  }

  void add_direct_within(const PhaseFunction& phase, int depth) {
    const std::optional<Lit> lit = pick_light(depth);
    if (!lit) return;
    const SampledSpectrum turned(pdf(phase, end_.ray.direction, lit->towards.wi));
    PathEnd start = end_;
    start.ray.direction = lit->towards.wi;
    add_through_media(*lit, turned_light(*lit, turned, 1),
                      lit->light.is_delta() ? SampledSpectrum(0.0F) : turned, start);
  }

  // Adds what is left of the light that comes along the ray of `start`, the direction of which scattering
  // would have drawn with `density`.
  [[gnu::noinline]] void add_through_media(const Lit& lit, const SampledSpectrum& contribution,
                                           const SampledSpectrum& density, const PathEnd& start) {
    if (blocked(start.ray, lit.towards)) return;
    const Transmission way = transmission(scene_, caster_, start, lit.towards.distance);
    const float balance =
        (end_.packet.lane_pdf * (SampledSpectrum(lit.density) + density * way.density)).sum();
    if (balance > 0) exposure_.deposit(contribution * way.transmittance * (1 / balance), lit.index);
  }

  // The medium that light from the local direction `wi` comes through.
  [[nodiscard]] Medium side_of(const Vertex& vertex, const Imath::V3f& wi) const {
    if (wi.z * vertex.wo.z > 0) return end_.medium;
    return leaving(scene_, end_, vertex, wi, end_.ray).medium;
  }

  [[nodiscard]] bool blocked(const Ray& ray, const LightSample& towards) {
    return std::isfinite(towards.distance) ? caster_.occluded(ray.origin, towards.end)
                                           : caster_.occluded(ray);
  }

  // Where light arrives to be scattered: at a point, on one side of a surface or from everywhere.
  struct Place {
    Imath::V3f point{0, 0, 0};
    std::optional<Imath::V3f> side = {};
    [[nodiscard]] const Imath::V3f* normal() const { return side ? &*side : nullptr; }
  };

  const Plan& plan_;
  const Scene& scene_;
  RayCaster& caster_;
  const Sampler& sampler_;
  PathExposure& exposure_;
  PathEnd end_;
  Place place_;                         // the vertex last met
  std::optional<Interface> interface_;  // met last, where matter may be nested
  bool has_free_paths_;
  int most_events_;
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
