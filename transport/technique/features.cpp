#include "transport/technique/features.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <variant>

#include "materials/bsdf/bsdf.h"
#include "sampling/discrete.h"
#include "sensor/response/stokes_channels.h"
#include "transport/path/dimensions.h"
#include "transport/path/roulette.h"
#include "transport/path/vertex.h"
#include "transport/technique/start_matter.h"

namespace abbe {
namespace {

// Over cells of a nanometre, by the size of a channel's weight there.
std::vector<double> response_cdf(const Channel& channel) {
  std::vector<double> cdf;
  for (int nm = kMinWavelengthNm; nm < kMaxWavelengthNm; ++nm)
    cdf.push_back(std::abs(channel.weight.integral(nm, nm + 1)));
  std::partial_sum(cdf.begin(), cdf.end(), cdf.begin());
  normalise_cdf(std::span(cdf));
  return cdf;
}

// Wavelengths that stand for equal shares of a response, shifted by `u` in [0, 1).
SampledSpectrum wavelengths_of(const std::vector<double>& cdf, float u) {
  SampledSpectrum::Values nm;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const auto [cell, within] =
        invert_cdf(std::span(cdf), (static_cast<double>(lane) + static_cast<double>(u)) / kLanes);
    nm[lane] = static_cast<float>(kMinWavelengthNm + static_cast<double>(cell) + within);
  }
  return SampledSpectrum(nm);
}

// Of what comes in along `wo`, the share that leaves in one event, whose mean over the numbers is the albedo.
// The hero alone follows what is dispersive, and stands then for all lanes.
double albedo_sample(const SurfaceVertex& vertex, const BsdfRandom& u, int hero) {
  const auto event = sample(vertex.bsdf, vertex.wo, u, hero, TransportMode::power);
  return event ? static_cast<double>(event->weight.sum() / event->lane_pdf.sum()) : 0;
}

Imath::V3d towards(const Imath::V3f& normal, const Imath::V3f& direction) {
  return Imath::V3d(normal.dot(direction) < 0 ? -normal : normal);
}

}  // namespace

FeatureTracer::FeatureTracer(const Plan& plan, std::span<const Feature> features, RayCaster& caster)
    : plan_(plan),
      scene_(plan.scene),
      camera_(traits(plan.scene.camera)),
      of_image_(without_ghosts(plan.scene.camera)),
      caster_(caster),
      features_(features.begin(), features.end()),
      planes_(feature_planes(features, plan.scene.film_planes()).size()) {
  if (std::find(features_.begin(), features_.end(), Feature::albedo) == features_.end()) return;
  for (const Channel& channel : intensities(scene_.channels)) responses_.push_back(response_cdf(channel));
}

void FeatureTracer::trace(std::span<const PixelSample> samples, bool first, const FeatureDeposit& deposit) {
  walks_.clear();
  rays_.clear();
  for (const PixelSample& sample : samples) {
    walks_.push_back(start(sample));
    rays_.push_back(walks_.back().ray);
  }
  hits_.resize(rays_.size());
  caster_.intersect(rays_, hits_);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    values_.clear();
    std::optional<SurfaceHit> hit = hits_[i];
    std::optional<Interface> met;
    lens_point_ = Imath::V3d(walks_[i].ray.origin);
    for (int passed = 0; hit && pass_boundary(walks_[i], *hit, met); ++passed)
      hit = passed < most_events(scene_.render) ? caster_.intersect(walks_[i].ray) : std::nullopt;
    if (hit) look(samples[i], first, *hit, met, walks_[i]);
    values_.resize(planes_);  // 0 of what meets nothing
    deposit(samples[i], values_);
  }
}

Walk FeatureTracer::start(const PixelSample& sample) const {
  Walk walk(sample.sampler, 0);
  const std::array<float, 4> film = sample.sampler.group(kFilmGroup);
  const std::array<float, 4> lens = sample.sampler.group(kLensGroup);
  walk.packet = draw_packet(plan_.wavelengths_at(sample.x, sample.y), film[2]);
  walk.ray =
      sample_ray(of_image_, {static_cast<float>(sample.x) + film[0], static_cast<float>(sample.y) + film[1]},
                 {lens[0], lens[1]}, walk.lambda_nm(), walk.packet.hero,
                 scene_.shutter.draw(sample.y, film[kTimeNumber]))
          .ray;
  enter_camera_matter(plan_, walk);
  return walk;
}

// Where the matter changes, but not the way of light, takes a ray to the other side.
bool FeatureTracer::pass_boundary(Walk& walk, SurfaceHit& hit, std::optional<Interface>& met) const {
  met.reset();
  if (scene_.needs.nesting) {
    met = interface_at(scene_, walk.ray, hit, walk.around.inside);
    hit = met->hit;
  }
  const SurfaceVertex vertex(scene_, hit, met, walk);
  const auto* interface = std::get_if<DielectricBsdf>(&vertex.bsdf);
  const bool same_index = interface != nullptr && interface->n[walk.packet.hero] == 1;
  const bool passes = same_index || (met && met->passes);
  if (!passes && !is_boundary(scene_.materials[scene_.shapes[hit.shape].material])) return false;
  walk.around.enter(scene_, vertex.behind(scene_, walk.around.inside), walk.lambda_nm());
  walk.ray = spawn(hit, walk.ray.direction, walk.ray.time);
  return true;
}

// Of a camera from its position along its axis, wherever its rays begin; of others from where the ray does.
double FeatureTracer::depth(const SurfaceHit& hit, const Ray& ray) const {
  if (camera_.axis) {
    const Ray at_rest = seen_at_rest(scene_.camera, ray_at(hit.point, ray.direction, ray.time));
    return (Imath::V3d(at_rest.origin) - position(scene_.camera)).dot(*camera_.axis);
  }
  const Imath::V3f along =
      is_meter(scene_.camera) ? meter_normal(scene_.camera, Imath::V3f(lens_point_)) : ray.direction;
  return (Imath::V3d(hit.point) - lens_point_).dot(Imath::V3d(along));
}

void FeatureTracer::look(const PixelSample& sample, bool first, const SurfaceHit& hit,
                         const std::optional<Interface>& met, Walk& walk) {
  const SurfaceVertex vertex(scene_, hit, met, walk);
  const Imath::V3f back = -walk.ray.direction;
  values_.push_back(1);
  for (const Feature feature : features_) {
    if (feature == Feature::depth) values_.push_back(depth(hit, walk.ray) / scene_.unit_m);
    if (feature == Feature::position) add((Imath::V3d(hit.point) + scene_.origin_m) / scene_.unit_m);
    if (feature == Feature::normal) add(towards(hit.normal, back));
    if (feature == Feature::shading_normal) add(towards(vertex.frame.to_world({0, 0, 1}), back));
    if (feature == Feature::albedo) add_albedo(sample, hit, met, walk);
    if (feature == Feature::id) values_.push_back(first ? static_cast<double>(hit.shape) + 1 : 0);
  }
}

void FeatureTracer::add_albedo(const PixelSample& sample, const SurfaceHit& hit,
                               const std::optional<Interface>& met, Walk& walk) {
  const auto [direction, number] = sample.sampler.two_groups(scattering_group(0));
  const BsdfRandom u{direction[2], {direction[0], direction[1]}};
  const int hero = std::min(static_cast<int>(number[1] * kLanes), kLanes - 1);
  const std::size_t channel =
      scene_.mosaic ? static_cast<std::size_t>(scene_.mosaic->at(sample.x, sample.y)) : 0;
  const std::size_t count = scene_.mosaic ? 1 : responses_.size();
  for (std::size_t k = channel; k < channel + count; ++k) {
    walk.packet.wavelengths.lambda_nm = wavelengths_of(responses_[k], number[0]);
    values_.push_back(albedo_sample(SurfaceVertex(scene_, hit, met, walk), u, hero));
  }
}

}  // namespace abbe
