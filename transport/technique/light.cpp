#include "transport/technique/light.h"

#include <array>
#include <cmath>

#include "transport/path/free_path.h"
#include "transport/path/packet.h"
#include "transport/path/roulette.h"
#include "transport/path/vertex.h"
#include "transport/technique/photon_start.h"

namespace abbe {
namespace {

constexpr std::uint32_t kAimGroup = 0;  // its fourth number is kept for the time within the exposure
constexpr std::uint32_t kStartGroup = 1;
constexpr std::uint32_t scatter_group(int depth) {
  return 2 + 2 * static_cast<std::uint32_t>(depth);
}
constexpr std::uint32_t lens_group(int depth) {
  return 3 + 2 * static_cast<std::uint32_t>(depth);
}
constexpr std::uint32_t free_path_group(int depth) {
  return 0x80000000 + static_cast<std::uint32_t>(depth);
}

class PhotonPath {
 public:
  PhotonPath(const Plan& plan, RayCaster& caster, const Sampler& sampler,
             const SampledWavelengths& wavelengths, double share, PathExposure& exposure, const Splat& splat)
      : plan_(plan),
        scene_(plan.scene),
        caster_(caster),
        sampler_(sampler),
        exposure_(exposure),
        splat_(splat),
        has_free_paths_(has_free_paths(scene_)),
        most_events_(most_events(scene_.render)) {
    exposure_.begin(wavelengths, static_cast<float>(share * scene_.exposure_s));
    end_.packet.wavelengths = wavelengths;
  }

  void trace(const Ray& start, const SampledSpectrum& power, const MediumStack& inside) {
    end_.ray = start;
    end_.inside = inside;
    if (!end_.inside.empty()) end_.medium = medium_within(scene_, end_.inside, lambda());
    end_.packet.throughput = power;
    power_ = power.max();
    for (int depth = 0;; ++depth) {
      std::optional<SurfaceHit> hit = caster_.intersect(end_.ray);
      const bool owned = depth > 0 || plan_.light_owns_all;
      if (has_free_paths_) {
        if (scatters_before(hit, depth)) {
          if (!owned || is_cut(depth) || !scatter_within(depth)) return;
          continue;
        }
      } else if (hit) {
        end_.medium.attenuate(end_.packet.throughput, hit->t);
      }
      if (!hit) return;
      if (scene_.needs.nesting) interface_ = interface_at(scene_, end_.ray, *hit, end_.inside);
      const Vertex vertex = interface_ ? Vertex(scene_, *interface_, end_.ray.direction, lambda())
                                       : Vertex(scene_, *hit, end_.ray.direction, lambda());
      if (is_black(vertex.bsdf) || is_cut(depth)) return;
      if (owned && scatters(vertex.bsdf)) connect(vertex, depth);
      if (!scatter(vertex, depth, owned)) return;
    }
  }

 private:
  [[nodiscard]] const SampledSpectrum& lambda() const { return end_.packet.wavelengths.lambda_nm; }

  // Whether the path may not have the event number `depth`, counted from 0.
  bool is_cut(int depth) {
    if (depth < most_events_) return false;
    caster_.count_cut(end_.packet.carried() / power_);
    return true;
  }

  [[nodiscard]] bool scatters_before(std::optional<SurfaceHit>& hit, int depth) {
    const std::array<float, 4> u = sampler_.group(free_path_group(depth));
    return propagate(scene_, caster_, {u[0], u[1]}, end_, hit).scattered;
  }

  bool scatter_within(int depth) {
    const PhaseFunction& phase = end_.medium.scattering->phase;
    connect_within(phase, depth);
    const std::array<float, 4> u = sampler_.group(scatter_group(depth));
    const Basis<float> frame(end_.ray.direction);
    end_.ray.direction = frame.to_world(sample(phase, {u[0], u[1]}).direction);
    return survives(1, depth, u[3]);
  }

  [[nodiscard]] std::optional<CameraConnection> pick_lens(const Imath::V3f& point, int depth) const {
    const std::array<float, 4> u =
        scene_.camera.is_pinhole() ? std::array<float, 4>{} : sampler_.group(lens_group(depth));
    return sample_towards(scene_.camera, point, {u[0], u[1]});
  }

  void connect(const Vertex& vertex, int depth) {
    const std::optional<CameraConnection> lens = pick_lens(vertex.hit.point, depth);
    if (!lens) return;
    const Imath::V3f towards = (lens->lens_point - vertex.hit.point).normalized();
    const Imath::V3f wi = vertex.frame.to_local(towards);
    const SampledSpectrum turned = vertex.towards(towards, wi, TransportMode::power);
    if (turned.is_zero()) return;
    const Ray ray = spawn(vertex.hit, towards);
    expose(*lens, turned, std::abs(wi.z), leaving(scene_, end_, vertex, wi, ray));
  }

  void connect_within(const PhaseFunction& phase, int depth) {
    const std::optional<CameraConnection> lens = pick_lens(end_.ray.origin, depth);
    if (!lens) return;
    PathEnd start = end_;
    start.ray.direction = (lens->lens_point - start.ray.origin).normalized();
    expose(*lens, SampledSpectrum(pdf(phase, end_.ray.direction, start.ray.direction)), 1, start);
  }

  // Adds what reaches the film along the ray of `start`, of the share of the photon's power that is sent that
  // way: `turned` times `cosine`.
  void expose(const CameraConnection& lens, const SampledSpectrum& turned, float cosine,
              const PathEnd& start) {
    if (caster_.occluded(start.ray.origin, lens.lens_point)) return;
    SampledSpectrum contribution =
        turned * (end_.packet.throughput * (cosine * lens.weight / end_.packet.lane_pdf.sum()));
    const float distance = (lens.lens_point - start.ray.origin).length();
    if (has_free_paths_)
      contribution *= transmission(scene_, caster_, start, distance).transmittance;
    else
      start.medium.attenuate(contribution, distance);
    const auto x = static_cast<int>(lens.film.x);
    const auto y = static_cast<int>(lens.film.y);
    exposure_.clear();
    exposure_.at_pixel(x, y);
    exposure_.at_angle(lens.cos_film);
    exposure_.deposit(contribution);
    splat_(x, y, exposure_.values());
  }

  // `owned`: whether paths that scatter here in more than a single direction are.
  bool scatter(const Vertex& vertex, int depth, bool owned) {
    const std::array<float, 4> u = sampler_.group(scatter_group(depth));
    const std::optional<BsdfSample> event = vertex.scatter({u[2], {u[0], u[1]}}, TransportMode::power);
    if (!event || !(owned || event->delta)) return false;
    end_.packet.throughput *= event->weight;
    end_.packet.lane_pdf *= event->lane_pdf;
    if (event->transmitted) end_.enter(scene_, vertex.behind(scene_, end_.inside));
    end_.ray = spawn(vertex.hit, vertex.frame.to_world(event->wi));
    return survives(event->weight.max() / event->lane_pdf.max(), depth, u[3]);
  }

  // Roulette by what the event itself `kept`: the power a photon starts with says nothing about what it adds
  // to the film.
  bool survives(float kept, int depth, float u) {
    if (end_.packet.throughput.is_zero()) return false;
    if (!plays_roulette(scene_.render, depth + 1)) return true;
    const float q = survival(kept, depth + 1);
    if (u >= q) return false;
    end_.packet.throughput *= 1 / q;
    return true;
  }

  const Plan& plan_;
  const Scene& scene_;
  RayCaster& caster_;
  const Sampler& sampler_;
  PathExposure& exposure_;
  const Splat& splat_;
  PathEnd end_;
  std::optional<Interface> interface_;  // met last, where matter may be nested
  bool has_free_paths_;
  int most_events_;
  float power_ = 0;  // that it set out with, its largest lane's
};

}  // namespace

PhotonStart trace_photon(const Plan& plan, RayCaster& caster, const Sampler& sampler, double share,
                         PathExposure& exposure, const Splat& splat) {
  const std::array<float, 4> a = sampler.group(kAimGroup);
  const std::array<float, 4> b = sampler.group(kStartGroup);
  const LightPicker::Pick pick = plan.traced_lights.pick(b[3]);
  const PhotonRay photon = start_photon(plan, caster, pick, {{a[0], a[1]}, {b[0], b[1]}, b[2]});
  const PhotonStart start{pick.light, photon.cell};
  if (!(photon.factor > 0)) return start;
  const SampledWavelengths wavelengths = plan.wavelengths.sample(a[2]);
  const SampledSpectrum power = plan.scene.lights[pick.light].emission(wavelengths.lambda_nm) * photon.factor;
  if (power.is_zero()) return start;  // at none of its wavelengths does the light shine
  PhotonPath(plan, caster, sampler, wavelengths, share, exposure, splat)
      .trace(photon.ray, power, plan.light_inside[pick.light]);
  return start;
}

}  // namespace abbe
