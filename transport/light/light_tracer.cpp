#include "transport/light/light_tracer.h"

#include <array>
#include <atomic>
#include <cmath>
#include <vector>

#include "transport/path/medium.h"
#include "transport/path/packet.h"
#include "transport/path/vertex.h"
#include "transport/render/threads.h"

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

class PhotonPath {
 public:
  PhotonPath(const Plan& plan, RayCaster& caster, const Sampler& sampler,
             const SampledWavelengths& wavelengths, double share, PathExposure& exposure, const Splat& splat)
      : plan_(plan),
        scene_(plan.scene),
        caster_(caster),
        sampler_(sampler),
        exposure_(exposure),
        splat_(splat) {
    exposure_.begin(wavelengths, static_cast<float>(share * scene_.exposure_s));
    packet_.wavelengths = wavelengths;
  }

  void trace(const Ray& start, const SampledSpectrum& power, const Enclosures& inside) {
    ray_ = start;
    inside_ = inside;
    if (!inside_.empty()) medium_ = medium_within(scene_, inside_, lambda());
    packet_.throughput = power;
    for (int depth = 0; depth < scene_.render.max_depth; ++depth) {
      const std::optional<SurfaceHit> hit = caster_.intersect(ray_);
      if (!hit) return;
      if (scene_.needs.nesting) interface_ = interface_at(scene_, ray_, *hit, inside_);
      const Vertex vertex = interface_ ? Vertex(scene_, *interface_, ray_.direction, lambda())
                                       : Vertex(scene_, *hit, ray_.direction, lambda());
      medium_.attenuate(packet_.throughput, hit->t);
      if (is_black(vertex.bsdf)) return;
      const bool owned = depth > 0 || plan_.light_owns_all;
      if (owned && scatters(vertex.bsdf)) connect(vertex, depth);
      if (!scatter(vertex, depth, owned)) return;
    }
  }

 private:
  [[nodiscard]] const SampledSpectrum& lambda() const { return packet_.wavelengths.lambda_nm; }

  void connect(const Vertex& vertex, int depth) {
    const std::array<float, 4> u =
        scene_.camera.is_pinhole() ? std::array<float, 4>{} : sampler_.group(lens_group(depth));
    const std::optional<CameraConnection> lens =
        sample_towards(scene_.camera, vertex.hit.point, {u[0], u[1]});
    if (!lens) return;
    const Imath::V3f towards = (lens->lens_point - vertex.hit.point).normalized();
    const Imath::V3f wi = vertex.frame.to_local(towards);
    SampledSpectrum contribution = vertex.towards(towards, wi, TransportMode::power);
    if (contribution.is_zero()) return;
    const Imath::V3f from = spawn(vertex.hit, towards).origin;
    if (caster_.occluded(from, lens->lens_point)) return;
    contribution *= packet_.throughput * (std::abs(wi.z) * lens->weight / packet_.lane_pdf.sum());
    const auto x = static_cast<int>(lens->film.x);
    const auto y = static_cast<int>(lens->film.y);
    exposure_.clear();
    exposure_.at_pixel(x, y);
    exposure_.at_angle(lens->cos_film);
    exposure_.deposit(contribution);
    splat_(x, y, exposure_.values());
  }

  // `owned`: whether paths that scatter here in more than a single direction are.
  bool scatter(const Vertex& vertex, int depth, bool owned) {
    const std::array<float, 4> u = sampler_.group(scatter_group(depth));
    const std::optional<BsdfSample> event = vertex.scatter({u[2], {u[0], u[1]}}, TransportMode::power);
    if (!event || !(owned || event->delta)) return false;
    packet_.throughput *= event->weight;
    packet_.lane_pdf *= event->lane_pdf;
    if (packet_.throughput.is_zero()) return false;
    if (event->transmitted) {
      inside_ = vertex.behind(scene_, inside_);
      medium_ = medium_within(scene_, inside_, lambda());
    }
    ray_ = spawn(vertex.hit, vertex.frame.to_world(event->wi));
    return survives(*event, depth, u[3]);
  }

  // Roulette by what the event itself kept: the power a photon starts with says nothing about its worth.
  bool survives(const BsdfSample& event, int depth, float u) {
    if (scene_.render.roulette_depth < 0 || depth + 1 < scene_.render.roulette_depth) return true;
    const float q = std::min(1.0F, std::max(0.1F, event.weight.max() / event.lane_pdf.max()));
    if (u >= q) return false;
    packet_.throughput *= 1 / q;
    return true;
  }

  const Plan& plan_;
  const Scene& scene_;
  RayCaster& caster_;
  const Sampler& sampler_;
  PathExposure& exposure_;
  const Splat& splat_;
  Ray ray_;
  PathPacket packet_;
  Enclosures inside_;
  Medium medium_;                       // within them
  std::optional<Interface> interface_;  // met last, where matter may be nested
};

// A photon that shows where to aim others, by what it adds to the film.
struct Pilot {
  PhotonStart start;
  double worth = 0;
};

std::vector<Pilot> trace_pilots(const Plan& plan, std::uint64_t seed, std::uint32_t stage, int threads) {
  constexpr std::uint32_t kPhotons = 1U << 17;
  constexpr std::uint32_t kBatch = 1U << 11;
  std::vector<Pilot> pilots(kPhotons);
  std::atomic<std::uint32_t> next = 0;
  run_on_threads(threads, [&] {
    RayCaster caster(plan.scene);
    PathExposure exposure = exposure_of(plan.scene);
    for (std::uint32_t first = kBatch * next++; first < kPhotons; first = kBatch * next++)
      for (std::uint32_t i = first; i < first + kBatch; ++i) {
        double& worth = pilots[i].worth;
        const Splat add = [&worth](int, int, std::span<const double> values) {
          for (const double v : values) worth += std::abs(v);
        };
        const Sampler sampler(seed, Purpose::pilot, stage, 0, i);
        pilots[i].start = trace_photon(plan, caster, sampler, 1, exposure, add);
      }
  });
  return pilots;
}

}  // namespace

PhotonStart trace_photon(const Plan& plan, RayCaster& caster, const Sampler& sampler, double share,
                         PathExposure& exposure, const Splat& splat) {
  const std::array<float, 4> a = sampler.group(kAimGroup);
  const std::array<float, 4> b = sampler.group(kStartGroup);
  const LightPicker::Pick pick = plan.traced_lights.pick(b[3]);
  const Light& light = plan.scene.lights[pick.light];
  const EmissionPoint from = sample_emission_point(light, plan.scene.shapes, {b[0], b[1]});
  const AimedDirection aimed = plan.aims[pick.light].sample(light, from, b[2], {a[0], a[1]});

  PhotonStart start{pick.light, aimed.cell};
  const bool area = std::holds_alternative<AreaLight>(light.kind);
  if (area && !emits_towards(light, from.normal, aimed.wi)) return start;
  if (const auto* spot = std::get_if<SpotLight>(&light.kind); spot && !spot->lights(aimed.wi)) return start;
  const SampledWavelengths wavelengths = plan.wavelengths.sample(a[2]);
  const float cosine = area ? std::abs(from.normal.dot(aimed.wi)) : 1.0F;
  const float factor = cosine / (pick.probability * from.pdf_area * aimed.pdf);
  const Ray ray = area ? spawn(from.point, from.normal, aimed.wi) : Ray{from.point, aimed.wi};
  PhotonPath(plan, caster, sampler, wavelengths, share, exposure, splat)
      .trace(ray, light.emission(wavelengths.lambda_nm) * factor, plan.light_inside[pick.light]);
  return start;
}

void learn_aims(Plan& plan, std::uint64_t seed, int threads) {
  // First where light passes at all, then, from photons aimed there, how much of it.
  constexpr std::array<int, 2> kReaches{4, 1};
  if (plan.traced_lights.empty()) return;
  for (std::uint32_t stage = 0; stage < kReaches.size(); ++stage) {
    std::vector<std::vector<double>> importance(plan.aims.size());
    for (std::size_t light = 0; light < plan.aims.size(); ++light)
      if (plan.aims[light].guided()) importance[light].resize(Aim::kGrid);
    // Added up in the order of the photons, whichever threads traced them.
    for (const auto& [start, worth] : trace_pilots(plan, seed, stage, threads))
      if (start.cell >= 0 && std::isfinite(worth))
        importance[start.light][static_cast<std::size_t>(start.cell)] += worth;
    for (std::size_t light = 0; light < plan.aims.size(); ++light)
      plan.aims[light].learn(importance[light], kReaches[stage]);
  }
}

}  // namespace abbe
