#include "transport/technique/features.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <variant>

#include "materials/bsdf.h"
#include "sampling/discrete.h"
#include "sensor/response/polarised_channels.h"
#include "transport/path/dimensions.h"
#include "transport/path/roulette.h"
#include "transport/path/vertex.h"
#include "transport/technique/path_starts.h"

namespace abbe {
namespace {

// Cumulative distribution of |channel weight| over cells of one nanometre.
std::vector<double> response_cdf(const Channel& channel) {
  std::vector<double> cdf;
  for (int nm = kMinWavelengthNm; nm < kMaxWavelengthNm; ++nm)
    cdf.push_back(std::abs(channel.weight.integral(nm, nm + 1)));
  std::partial_sum(cdf.begin(), cdf.end(), cdf.begin());
  normalise_cdf(std::span(cdf));
  return cdf;
}

// Wavelengths at equal fractions of a response, shifted by `u` in [0, 1).
SampledSpectrum wavelengths_of(const std::vector<double>& cdf, float u) {
  SampledSpectrum::Values nm;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const auto [cell, within] =
        invert_cdf(std::span(cdf), (static_cast<double>(lane) + static_cast<double>(u)) / kLanes);
    nm[lane] = static_cast<float>(kMinWavelengthNm + static_cast<double>(cell) + within);
  }
  return SampledSpectrum(nm);
}

// Fraction of the light from `wo` that one sampled event scatters; its mean over the random numbers is the
// albedo. At a dispersive event the hero represents all wavelengths.
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
      camera_without_ghosts_(without_ghosts(plan.scene.camera)),
      caster_(caster),
      features_(features.begin(), features.end()),
      planes_(feature_planes(features, plan.scene.film_planes()).size()) {
  if (std::find(features_.begin(), features_.end(), Feature::albedo) == features_.end()) return;
  for (const Channel& channel : intensities(scene_.channels)) responses_.push_back(response_cdf(channel));
}

void FeatureTracer::trace(std::span<const PixelSample> samples, bool first, const FeatureDeposit& deposit) {
  paths_.clear();
  rays_.clear();
  for (const PixelSample& sample : samples) {
    paths_.push_back(start(sample));
    rays_.push_back(paths_.back().ray);
  }
  hits_.resize(rays_.size());
  caster_.intersect(rays_, hits_);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    values_.clear();
    std::optional<SurfaceHit> hit = hits_[i];
    std::optional<Interface> interface;
    lens_point_ = Imath::V3d(paths_[i].ray.origin);
    for (int passed = 0; hit && pass_boundary(paths_[i], *hit, interface); ++passed)
      hit = passed < depth_limit(scene_.render) ? caster_.intersect(paths_[i].ray) : std::nullopt;
    if (hit) record_features(samples[i], first, *hit, interface, paths_[i]);
    values_.resize(planes_);  // zeros if nothing is hit
    deposit(samples[i], values_);
  }
}

PathState FeatureTracer::start(const PixelSample& sample) const {
  PathState path(sample.sampler, 0);
  const std::array<float, 4> film = sample.sampler.group(kFilmGroup);
  const std::array<float, 4> lens = sample.sampler.group(kLensGroup);
  path.packet = draw_packet(plan_.wavelengths_at(sample.x, sample.y), film[2]);
  path.ray = sample_ray(camera_without_ghosts_,
                        {static_cast<float>(sample.x) + film[0], static_cast<float>(sample.y) + film[1]},
                        {lens[0], lens[1]}, path.lambda_nm(), path.packet.hero,
                        scene_.shutter.sample(sample.y, film[kTimeIndex]))
                 .ray;
  enter_camera_media(plan_, path);
  return path;
}

// Moves a ray through a boundary at which the medium changes but light is not refracted. Returns false at
// other surfaces.
bool FeatureTracer::pass_boundary(PathState& path, SurfaceHit& hit,
                                  std::optional<Interface>& interface) const {
  interface.reset();
  if (scene_.features.nesting) {
    interface = interface_at(scene_, path.ray, hit, path.media.stack);
    hit = interface->hit;
  }
  const SurfaceVertex vertex(scene_, hit, interface, path);
  const auto* dielectric = std::get_if<DielectricBsdf>(&vertex.bsdf);
  const bool same_index = dielectric != nullptr && dielectric->n[path.packet.hero] == 1;
  const bool passes = same_index || (interface && interface->passes);
  if (!passes && !is_boundary(scene_.materials[scene_.shapes[hit.shape].material])) return false;
  path.media.enter(scene_, vertex.media_behind(scene_, path.media.stack), path.lambda_nm());
  path.ray = spawn(hit, path.ray.direction, path.ray.time);
  return true;
}

// Depth along the camera's axis from its position; for a camera without an axis, from the start of the ray.
double FeatureTracer::depth(const SurfaceHit& hit, const Ray& ray) const {
  if (camera_.axis) {
    const Ray at_rest = ray_in_rest_frame(scene_.camera, ray_at(hit.point, ray.direction, ray.time));
    return (Imath::V3d(at_rest.origin) - position(scene_.camera)).dot(*camera_.axis);
  }
  const Imath::V3f along =
      is_probe(scene_.camera) ? probe_normal(scene_.camera, Imath::V3f(lens_point_)) : ray.direction;
  return (Imath::V3d(hit.point) - lens_point_).dot(Imath::V3d(along));
}

void FeatureTracer::record_features(const PixelSample& sample, bool first, const SurfaceHit& hit,
                                    const std::optional<Interface>& interface, PathState& path) {
  const SurfaceVertex vertex(scene_, hit, interface, path);
  const Imath::V3f back = -path.ray.direction;
  values_.push_back(1);
  for (const Feature feature : features_) {
    if (feature == Feature::depth) values_.push_back(depth(hit, path.ray) / scene_.unit_m);
    if (feature == Feature::position) add((Imath::V3d(hit.point) + scene_.origin_m) / scene_.unit_m);
    if (feature == Feature::normal) add(towards(hit.normal, back));
    if (feature == Feature::shading_normal) add(towards(vertex.frame.to_world({0, 0, 1}), back));
    if (feature == Feature::albedo) add_albedo(sample, hit, interface, path);
    if (feature == Feature::id) values_.push_back(first ? static_cast<double>(hit.shape) + 1 : 0);
  }
}

void FeatureTracer::add_albedo(const PixelSample& sample, const SurfaceHit& hit,
                               const std::optional<Interface>& interface, PathState& path) {
  const auto [direction, number] = sample.sampler.two_groups(scattering_group(0));
  const BsdfRandom u{direction[2], {direction[0], direction[1]}};
  const int hero = std::min(static_cast<int>(number[1] * kLanes), kLanes - 1);
  const std::size_t channel =
      scene_.mosaic ? static_cast<std::size_t>(scene_.mosaic->at(sample.x, sample.y)) : 0;
  const std::size_t count = scene_.mosaic ? 1 : responses_.size();
  for (std::size_t k = channel; k < channel + count; ++k) {
    path.packet.wavelengths.lambda_nm = wavelengths_of(responses_[k], number[0]);
    values_.push_back(albedo_sample(SurfaceVertex(scene_, hit, interface, path), u, hero));
  }
}

}  // namespace abbe
