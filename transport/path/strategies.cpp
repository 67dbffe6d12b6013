#include "transport/path/strategies.h"

#include <algorithm>
#include <cmath>

#include "transport/path/connect.h"
#include "transport/path/joined_vertices.h"
#include "transport/path/roulette.h"

namespace abbe {
namespace {

bool is_delta_light(const Scene& scene, const PathVertex& vertex) {
  const auto* light = std::get_if<LightVertex>(&vertex.at);
  return light != nullptr && scene.lights[light->light].is_delta();
}

// Of a direction that the vertex `from` draws to its neighbour `to`.
SampledSpectrum direction_between(const Scene& scene, const JoinedPath& path, std::size_t from,
                                  std::size_t to) {
  const PathVertex& vertex = *path.z[from];
  const std::size_t other = to > from ? from - 1 : from + 1;
  const bool camera = other >= path.z.size();
  const Imath::V3f before = camera ? Imath::V3f(0) : way_from(vertex, *path.z[other]).direction;
  return direction_pdf(scene, vertex, before, way_from(vertex, *path.z[to]).direction);
}

// Whether light goes on at a vertex in more than a single direction.
bool joins(const JoinedPath& path, std::size_t i) {
  const std::size_t last = path.z.size() - 1;
  const bool joint = path.t <= last && (i + 1 == path.t || (i == path.t && path.merged == nullptr));
  return i == 0 || i == last || joint || !path.z[i]->delta;
}

// How many vertices the light makes where the camera makes `t`.
std::size_t rest_of(const JoinedPath& path, std::size_t t) {
  return path.z.size() - std::min(t, path.z.size());
}

// Which share of the paths from both ends roulette lets have so many vertices,
float kept(const JoinedPath& path, std::size_t t) {
  return kept_share(t) * kept_share(rest_of(path, t));
}

// and which share of these is joined at the last of both.
float joined(const JoinedPath& path, std::size_t t) {
  const std::size_t rest = rest_of(path, t);
  return rest == 0 ? 1 : joined_share(t) * joined_share(rest);
}

// How many paths of strategy `t` there are for each path through the pixel; 0 where it cannot make this one.
float count(const JoinedPath& path, const EndDensities& ends, std::size_t t) {
  const std::size_t last = path.z.size() - 1;
  if (t > last) return 1;
  if (!joins(path, t - 1) || !joins(path, t)) return 0;
  if (t > 1) return 1;
  return t == last ? static_cast<float>(ends.camera_takes_lights) : ends.lens_connections;
}

// The same of merging at the last of the first `t` vertices, times the area.
float merging(const JoinedPath& path, const EndDensities& ends, std::size_t t) {
  const bool on_surface = t > 1 && std::holds_alternative<SurfaceVertex>(path.z[t - 1]->at);
  return on_surface && t < path.z.size() && joins(path, t - 1) ? ends.merging : 0;
}

}  // namespace

StrategyWeights::StrategyWeights(const Scene& scene, RayCaster& caster)
    : scene_(scene), caster_(caster), has_free_paths_(has_free_paths(scene)) {}

// Vertices that their own path has drawn know how, and beyond the two next to the joint how the other way;
// beside the joint that depends on what is joined.
SampledSpectrum StrategyWeights::by_camera(const JoinedPath& path, std::size_t i) const {
  const PathVertex& vertex = *path.z[i];
  if (i < path.t) return vertex.pdf_forward;
  if (is_delta_light(scene_, vertex)) return {};
  if (i > path.t + 1 || (i > path.t && path.merged != nullptr)) return vertex.pdf_reverse;
  return drawn(path, direction_between(scene_, path, i - 1, i), i - 1, i);
}

SampledSpectrum StrategyWeights::by_light(const JoinedPath& path, const EndDensities& ends,
                                          std::size_t i) const {
  const std::size_t last = path.z.size() - 1;
  const PathVertex& vertex = *path.z[i];
  if (i == last) return SampledSpectrum(ends.light_start);
  if (i + 1 == path.t && path.merged != nullptr) return path.merged->pdf_forward;
  const bool emitted = i + 1 == last;
  if (emitted && !(ends.emission > 0)) return {};
  if (i >= path.t) return vertex.pdf_forward;
  if (i + 2 < path.t) return vertex.pdf_reverse;
  return drawn(path, emitted ? SampledSpectrum(ends.emission) : direction_between(scene_, path, i + 1, i),
               i + 1, i);
}

SampledSpectrum StrategyWeights::drawn(const JoinedPath& path, const SampledSpectrum& direction,
                                       std::size_t from, std::size_t to) const {
  const PathVertex& a = *path.z[from];
  const PathVertex& b = *path.z[to];
  return direction * solid_angle_per_area(scene_, a, b) * b.event_pdf *
         (std::max(from, to) == path.t ? path.passed : passed_between(a, b));
}

SampledSpectrum StrategyWeights::passed_between(const PathVertex& a, const PathVertex& b) const {
  if (!has_free_paths_) return SampledSpectrum(1.0F);
  if (a.at_infinity()) return passed_between(b, a);  // both ways alike; none can start there
  return transmission_along(scene_, caster_, a, way_from(a, b)).density;
}

float StrategyWeights::of(const JoinedPath& path, const EndDensities& ends) {
  const std::size_t last = path.z.size() - 1;
  const int hero = path.z[0]->packet.hero;
  // Everything over the hero's density of the strategy in hand. First what the light makes of z_t' ... z_k,
  at_.resize(last + 1);
  from_light_.assign(last + 2, SampledSpectrum(1.0F));
  sum_ = own_ = SampledSpectrum();
  for (std::size_t i = last; i > 0; --i) {
    Densities& at = at_[i];
    at.by_camera = by_camera(path, i);
    at.by_light = by_light(path, ends, i);
    at.ours = i < path.t ? at.by_camera[hero] : at.by_light[hero];
    if (i == last && path.t == last && path.merged == nullptr) at.ours = ends.light_connection;
    // What was drawn on the rim of a lamp's cone, or left for what is far, may be nothing that the lamp
    // sends.
    if (!(at.ours > 0)) return 0;
    from_light_[i] = from_light_[i + 1] * at.by_light * (1 / at.ours);
  }
  // then, strategy by strategy, times what the camera makes of z_1 ... z_{t'-1}.
  const SampledSpectrum connected(ends.light_connection / at_[last].ours);
  SampledSpectrum from_camera(1.0F);
  for (std::size_t t = 1; t <= last + 1; ++t) {
    if (const float n = count(path, ends, t) * kept(path, t); n > 0) {
      const SampledSpectrum density = from_camera * (t == last ? connected : from_light_[t]) * n;
      sum_ += density * joined(path, t);
      if (t >= last) own_ += density;
    }
    if (const float n = merging(path, ends, t) * kept(path, t) * joined(path, t); n > 0)
      sum_ += from_camera * at_[t - 1].by_light * from_light_[t] * n;
    if (t <= last) from_camera *= at_[t].by_camera * (1 / at_[t].ours);
  }
  // Throughputs are measured in the unit of their lane densities, which need not be that of the hero.
  float unit = path.z[path.t - 1]->packet.lane_pdf[hero];
  if (path.merged != nullptr)
    unit *= path.merged->packet.lane_pdf[hero] / path.merged->pdf_forward[hero];
  else if (path.t <= last)
    unit *= path.z[path.t]->packet.lane_pdf[hero];
  const float weight = kept(path, path.t) * joined(path, path.t) / (sum_.sum() * unit);
  return std::isfinite(weight) ? weight : 0.0F;
}

}  // namespace abbe
