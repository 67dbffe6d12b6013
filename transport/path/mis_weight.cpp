#include "transport/path/mis_weight.h"

#include <algorithm>
#include <cmath>

#include "transport/path/connect.h"
#include "transport/path/roulette.h"

namespace abbe {
namespace {

// W / own for the power heuristic, arranged so that no square overflows.
float weigh_by_squares(float own, float other) {
  const float ratio = other / own;
  return 1 / (own * (1 + ratio * ratio));
}

bool is_delta_light(const Scene& scene, const PathVertex& vertex) {
  const auto* light = std::get_if<LightVertex>(&vertex.at);
  return light != nullptr && scene.lights[light->light].is_delta();
}

// Pdf [1/sr] with which the vertex `from` samples the direction to its neighbour `to`.
SampledSpectrum direction_between(const Scene& scene, const JoinedPath& path, std::size_t from,
                                  std::size_t to) {
  const PathVertex& vertex = *path.z[from];
  const std::size_t other = to > from ? from - 1 : from + 1;
  const bool camera = other >= path.z.size();
  const Imath::V3f before = camera ? Imath::V3f(0) : segment_between(vertex, *path.z[other]).direction;
  return direction_pdf(scene, vertex, before, segment_between(vertex, *path.z[to]).direction);
}

// True if the vertex scatters into more than a single direction.
bool is_connectible(const JoinedPath& path, std::size_t i) {
  const std::size_t last = path.z.size() - 1;
  const bool joint = path.t <= last && (i + 1 == path.t || (i == path.t && path.merged == nullptr));
  return i == 0 || i == last || joint || !path.z[i]->delta;
}

// Number of light vertices if the camera subpath has `t` vertices.
std::size_t light_vertex_count(const JoinedPath& path, std::size_t t) {
  return path.z.size() - std::min(t, path.z.size());
}

// Fraction of the subpaths of both ends that roulette lets get to these lengths.
float expected_survival(const JoinedPath& path, std::size_t t) {
  return survival_fraction(t) * survival_fraction(light_vertex_count(path, t));
}

// Probability that the last vertices of both subpaths are connected.
float joining_fraction(const JoinedPath& path, std::size_t t) {
  const std::size_t rest = light_vertex_count(path, t);
  return rest == 0 ? 1 : joining_probability(t) * joining_probability(rest);
}

// Number of paths of strategy `t` per camera path; 0 if it cannot sample this path.
float sample_count(const JoinedPath& path, const EndDensities& ends, std::size_t t) {
  const std::size_t last = path.z.size() - 1;
  if (t > last) return 1;
  if (!is_connectible(path, t - 1) || !is_connectible(path, t)) return 0;
  if (t > 1) return 1;
  return t == last ? static_cast<float>(ends.lights_connect_to_camera) : ends.lens_connections;
}

// Merging at the last of the first `t` vertices: number of paths times the merging area; 0 if it cannot merge
// there.
float merging_count(const JoinedPath& path, const EndDensities& ends, std::size_t t) {
  const bool on_surface = t > 1 && std::holds_alternative<SurfaceVertex>(path.z[t - 1]->at);
  return on_surface && t < path.z.size() && is_connectible(path, t - 1) ? ends.merging : 0;
}

}  // namespace

float LightWeights::weigh_emission(float scattered, float connection_pdf, float path_pdf) const {
  const float other = connection_pdf * path_pdf;
  if (lights_ == LightStrategy::mis) return weigh_by_squares(scattered, other);
  return lights_ == LightStrategy::light && other > 0 ? 0 : 1 / scattered;
}

float LightWeights::weigh_connection(float scattered, float connection_pdf, float path_pdf) const {
  const float own = connection_pdf * path_pdf;
  return lights_ == LightStrategy::mis ? weigh_by_squares(own, scattered) : 1 / own;
}

StrategyWeights::StrategyWeights(const Scene& scene, RayCaster& caster)
    : scene_(scene), caster_(caster), has_free_paths_(has_free_paths(scene)) {}

// A vertex sampled by its own subpath has its pdf; past the two vertices next to the connection it also has
// the reverse pdf. Next to the connection the reverse pdf depends on the other subpath.
SampledSpectrum StrategyWeights::pdf_from_camera(const JoinedPath& path, std::size_t i) const {
  const PathVertex& vertex = *path.z[i];
  if (i < path.t) return vertex.pdf_forward;
  if (is_delta_light(scene_, vertex)) return {};
  if (i > path.t + 1 || (i > path.t && path.merged != nullptr)) return vertex.pdf_reverse;
  return area_pdf(path, direction_between(scene_, path, i - 1, i), i - 1, i);
}

SampledSpectrum StrategyWeights::pdf_from_light(const JoinedPath& path, const EndDensities& ends,
                                                std::size_t i) const {
  const std::size_t last = path.z.size() - 1;
  const PathVertex& vertex = *path.z[i];
  if (i == last) return SampledSpectrum(ends.light_start);
  if (i + 1 == path.t && path.merged != nullptr) return path.merged->pdf_forward;
  const bool emitted = i + 1 == last;
  if (emitted && !(ends.emission > 0)) return {};
  if (i >= path.t) return vertex.pdf_forward;
  if (i + 2 < path.t) return vertex.pdf_reverse;
  return area_pdf(path, emitted ? SampledSpectrum(ends.emission) : direction_between(scene_, path, i + 1, i),
                  i + 1, i);
}

SampledSpectrum StrategyWeights::area_pdf(const JoinedPath& path, const SampledSpectrum& direction,
                                          std::size_t from, std::size_t to) const {
  const PathVertex& a = *path.z[from];
  const PathVertex& b = *path.z[to];
  return direction * solid_angle_per_area(scene_, a, b) * b.event_pdf *
         (std::max(from, to) == path.t ? path.passing_pdf : passing_pdf_between(a, b));
}

SampledSpectrum StrategyWeights::passing_pdf_between(const PathVertex& a, const PathVertex& b) const {
  if (!has_free_paths_) return SampledSpectrum(1.0F);
  if (a.at_infinity()) return passing_pdf_between(b, a);  // symmetric, and no ray can start at infinity
  return transmission_along(scene_, caster_, a, segment_between(a, b)).pdf;
}

float StrategyWeights::weight_of(const JoinedPath& path, const EndDensities& ends) {
  const std::size_t last = path.z.size() - 1;
  const int hero = path.z[0]->packet.hero;
  // All pdfs are relative to the hero's pdf of the current strategy. First the products of light pdfs over
  // z_t' ... z_L.
  vertex_pdfs_.resize(last + 1);
  from_light_.assign(last + 2, SampledSpectrum(1.0F));
  sum_ = path_tracing_sum_ = SampledSpectrum();
  for (std::size_t i = last; i > 0; --i) {
    VertexPdfs& pdfs = vertex_pdfs_[i];
    pdfs.pdf_from_camera = pdf_from_camera(path, i);
    pdfs.pdf_from_light = pdf_from_light(path, ends, i);
    pdfs.current = i < path.t ? pdfs.pdf_from_camera[hero] : pdfs.pdf_from_light[hero];
    if (i == last && path.t == last && path.merged == nullptr) pdfs.current = ends.light_connection;
    // A point on the rim of a light's cone, or rounded for a distant light, may receive no emission at all.
    if (!(pdfs.current > 0)) return 0;
    from_light_[i] = from_light_[i + 1] * pdfs.pdf_from_light * (1 / pdfs.current);
  }
  // Then, for each strategy, the product of camera pdfs over z_1 ... z_{t'-1}.
  const SampledSpectrum light_connection(ends.light_connection / vertex_pdfs_[last].current);
  SampledSpectrum from_camera(1.0F);
  for (std::size_t t = 1; t <= last + 1; ++t) {
    if (const float n = sample_count(path, ends, t) * expected_survival(path, t); n > 0) {
      const SampledSpectrum density = from_camera * (t == last ? light_connection : from_light_[t]) * n;
      sum_ += density * joining_fraction(path, t);
      if (t >= last) path_tracing_sum_ += density;
    }
    if (const float n = merging_count(path, ends, t) * expected_survival(path, t) * joining_fraction(path, t);
        n > 0)
      sum_ += from_camera * vertex_pdfs_[t - 1].pdf_from_light * from_light_[t] * n;
    if (t <= last) from_camera *= vertex_pdfs_[t].pdf_from_camera * (1 / vertex_pdfs_[t].current);
  }
  // Throughputs are in the unit of their lane pdfs, which need not be that of the hero.
  float unit = path.z[path.t - 1]->packet.lane_pdf[hero];
  if (path.merged != nullptr)
    unit *= path.merged->packet.lane_pdf[hero] / path.merged->pdf_forward[hero];
  else if (path.t <= last)
    unit *= path.z[path.t]->packet.lane_pdf[hero];
  const float weight = expected_survival(path, path.t) * joining_fraction(path, path.t) / (sum_.sum() * unit);
  return std::isfinite(weight) ? weight : 0.0F;
}

}  // namespace abbe
