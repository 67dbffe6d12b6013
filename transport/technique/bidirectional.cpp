#include "transport/technique/bidirectional.h"

#include <algorithm>
#include <iterator>
#include <variant>

#include "materials/bsdf/warp.h"
#include "transport/path/connect.h"
#include "transport/path/dimensions.h"
#include "transport/path/polarised_paths.h"
#include "transport/technique/path_starts.h"

namespace abbe {
namespace {

// Random numbers for the connection of vertex `i` (from 0).
std::array<float, 4> connection_random(const Sampler& sampler, std::size_t i) {
  return sampler.group(scattering_group(static_cast<int>(i) - 1) + 1);
}

}  // namespace

void LightSubpaths::begin(std::size_t paths, const PathPacket& packet, float time) {
  batches_.resize((paths + kBatchSize - 1) / kBatchSize);
  size_ = paths;
  packet_ = packet;
  time_ = time;
}

void LightSubpaths::store(std::size_t batch, std::span<RecordedPath> paths) {
  Batch& stored = batches_[batch];
  stored.vertices.clear();
  stored.ends.clear();
  stored.samplers.clear();
  std::size_t vertices = 0;
  for (const RecordedPath& path : paths) vertices += path.vertices.size();
  stored.vertices.reserve(vertices);
  for (RecordedPath& path : paths) {
    std::ranges::move(path.vertices, std::back_inserter(stored.vertices));
    stored.ends.push_back(static_cast<std::uint32_t>(stored.vertices.size()));
    stored.samplers.push_back(path.sampler);
  }
}

void LightSubpaths::finish(float radius) {
  radius_ = radius;
  scattering_.clear();
  std::vector<Imath::V3f> points;
  for (std::uint32_t path = 0; path < size_; ++path) {
    const std::span<const PathVertex> vertices = (*this)[path].vertices;
    for (std::uint32_t k = 1; k < vertices.size(); ++k) {
      const auto* surface = std::get_if<SurfaceVertex>(&vertices[k].at);
      if (surface == nullptr || !scatters(surface->bsdf)) continue;
      scattering_.push_back({path, k});
      points.push_back(point_of(vertices[k]));
    }
  }
  map_ = PhotonMap(std::move(points));
}

LightSubpaths::Path LightSubpaths::operator[](std::size_t path) const {
  const Batch& batch = batches_[path / kBatchSize];
  const std::size_t i = path % kBatchSize;
  const std::size_t first = i == 0 ? 0 : batch.ends[i - 1];
  return {std::span(batch.vertices).subspan(first, batch.ends[i] - first), batch.samplers[i]};
}

void LightSubpaths::find_nearby(const Imath::V3f& point, std::vector<Vertex>& found) const {
  thread_local std::vector<std::uint32_t> numbers;
  map_.within(point, radius_, numbers);
  found.clear();
  for (const std::uint32_t number : numbers) found.push_back(scattering_[number]);
}

BidirectionalTracer::BidirectionalTracer(const Plan& plan, RayCaster& caster)
    : plan_(plan),
      scene_(plan.scene),
      caster_(caster),
      probe_(is_probe(plan.scene.camera)),
      max_vertices_(static_cast<std::size_t>(depth_limit(plan.scene.render)) + 2),
      response_(film_response_of(plan.scene)),
      from_camera_(plan.scene, caster),
      from_light_(plan.scene, caster),
      ghosts_(plan, caster),
      radiance_(plan.scene),
      weights_(plan.scene, caster) {}

void BidirectionalTracer::trace(std::span<const PixelPair> samples, const LightSubpaths& subpaths,
                                const Deposit& deposit) {
  shared_subpaths_ = &subpaths;
  trace(samples, deposit);
  shared_subpaths_ = nullptr;
}

void BidirectionalTracer::trace(std::span<const PixelPair> samples, const Deposit& deposit) {
  deposit_ = &deposit;
  for (std::size_t first = 0; first < samples.size(); first += kBatchSize)
    trace_batch(samples.subspan(first, std::min<std::size_t>(kBatchSize, samples.size() - first)),
                static_cast<std::uint32_t>(first));
}

// The estimate of a film value is a sum over camera subpaths x_0 x_1 ... and light subpaths y_0 y_1 ... of
//     sum_st w_st [T_x / P_x] [T_y / P_y] f_x f_y G T.
// These are the throughputs up to x_{t-1} and y_{s-1} over their pdfs, times the connection of both
// (`connect`). For s = 0 x_t is an emitter hit, for s = 1 a point of a light is sampled for x_{t-1} instead
// of y_0. For t = 1 a point of the lens is sampled for y_{s-1}, which may expose another pixel. Merging x
// with y within r adds
//     sum_y w [T_x / P_x] [T_y / P_y] f / (pi r^2 N).
// `StrategyWeights` balances all strategies. Both subpaths have the same time, uniform over the whole
// exposure, so that they can be connected. Contributions have the weight `Shutter::weight` of their film row
// at that time. The balance is that of one path at one time.
void BidirectionalTracer::trace_batch(std::span<const PixelPair> samples, std::uint32_t first) {
  first_ = first;
  samples_ = samples;
  from_camera_.paths().clear();
  from_light_.paths().clear();
  film_points_.assign(samples.size(), {});
  images_.resize(samples.size());
  radiance_.reset(samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    const PixelPair& sample = samples[i];
    RecordedPath& eye = from_camera_.paths().emplace_back(sample.camera, i);
    const std::array<float, 4> film = sample.camera.group(kFilmGroup);
    const float time = shared_subpaths_ == nullptr ? film[kTimeIndex] : shared_subpaths_->time();
    if (shared_subpaths_ == nullptr) {
      RecordedPath& photon = from_light_.paths().emplace_back(sample.light, i);
      photon.packet = draw_packet(plan_.wavelengths, film[2]);
      eye.packet = photon.packet;
      start_from_light(plan_, caster_, time, photon);
    } else {
      eye.packet = shared_subpaths_->packet();
    }
    if (!sample.exposes_pixel) continue;
    film_points_[i] = start_from_camera(plan_, sample.x, sample.y, time, eye, images_[i]);
    if (ghosts_.any())
      ghosts_.connect(sample.camera, eye.packet.wavelengths, first_ + i, *deposit_, layer_sink_);
  }
  from_camera_.run();
  from_light_.run();
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    join(i);
    if (samples[i].exposes_pixel)
      radiance_.visit(i, [&](const auto& value) { expose(i, film_points_[i], value); });
  }
}

void BidirectionalTracer::join(std::uint32_t i) {
  const RecordedPath& eye = from_camera_.paths()[i];
  const LightSubpaths::Path photon = own_light_subpath(i);
  joining_weight_ = 1;
  for (const EmitterHit& emitter_hit : eye.emitter_hits) add_emission(i, emitter_hit);
  choose_joined(eye.vertices, eye.sampler, joined_camera_vertices_);
  choose_joined(photon.vertices, photon.sampler, joined_light_vertices_);
  for (const JoinedVertex& x : joined_camera_vertices_)
    if (probe_ || x.number > 1) join(i, x);
  for (const JoinedVertex& y : joined_light_vertices_) {
    if (probe_ || y.number == 1 || y.number >= max_vertices_) continue;
    joining_weight_ = y.weight;
    connect_to_lens(i, y.number);
  }
}

// Connects or merges a camera vertex with lights and light subpaths.
void BidirectionalTracer::join(std::uint32_t i, const JoinedVertex& x) {
  joining_weight_ = x.weight;
  if (x.number < max_vertices_) connect_to_light(i, x.number);
  for (const JoinedVertex& y : joined_light_vertices_) {
    if (y.number == 1 || x.number + y.number > max_vertices_) continue;
    joining_weight_ = x.weight * y.weight;
    connect(i, x.number, y.number);
  }
  joining_weight_ = x.weight;
  const PathVertex& vertex = from_camera_.paths()[i].vertices[x.number - 1];
  if (shared_subpaths_ != nullptr && x.number > 1 && std::holds_alternative<SurfaceVertex>(vertex.at))
    merge(i, x.number);
}

// Adds an emitter hit of the camera subpath.
void BidirectionalTracer::add_emission(std::uint32_t i, const EmitterHit& emitter_hit) {
  if (emitter_hit.vertex_count == 1 && on_ghost(from_camera_.paths()[i].vertices.front()))
    return;  // see `GhostLights`
  set_joined(i, emitter_hit.vertex_count, own_light_subpath(i), 0);
  joined_.z.push_back(&emitter_hit.vertex);
  joined_.t = joined_.z.size();
  joined_.passing_pdf = SampledSpectrum(1.0F);
  const PathVertex& illuminated = *joined_.z[emitter_hit.vertex_count - 1];
  const auto& light = std::get<LightVertex>(emitter_hit.vertex.at);
  const Imath::V3f towards = segment_between(illuminated, emitter_hit.vertex).direction;
  const PathPacket& packet = emitter_hit.vertex.packet;
  const Light& emitter = scene_.lights[light.light];
  add(i, film_points_[i], light.light,
      packet.throughput * emission_from(emitter, towards, packet.wavelengths.lambda_nm) * weight(),
      measured_emission(emitter, packet, towards));
}

// Connects camera vertex `t`, from 1, to a light sampled for it.
void BidirectionalTracer::connect_to_light(std::uint32_t i, std::size_t t) {
  const RecordedPath& eye = from_camera_.paths()[i];
  const auto light = sample_light_vertex(plan_, eye.vertices[t - 1], connection_random(eye.sampler, t - 1));
  if (!light) return;
  set_joined(i, t, own_light_subpath(i), 0);
  joined_.z.push_back(&*light);
  add_joined(i, film_point(i, t, *light));
}

// Connects camera vertex `t` with light vertex `s`, both from 1.
void BidirectionalTracer::connect(std::uint32_t i, std::size_t t, std::size_t s) {
  set_joined(i, t, own_light_subpath(i), s);
  add_joined(i, film_point(i, t, own_light_subpath(i).vertices[s - 1]));
}

// Connects light vertex `s`, from 1, to a point of the lens sampled for it, which may expose any pixel.
void BidirectionalTracer::connect_to_lens(std::uint32_t i, std::size_t s) {
  const LightSubpaths::Path photon = own_light_subpath(i);
  const PathVertex& from = photon.vertices[s - 1];
  const std::array<float, 4> u = connection_random(photon.sampler, s - 1);
  const auto lens_point =
      sample_towards(scene_.camera, point_of(from), {u[0], u[1]}, from.lambda_nm(), from.time);
  if (!lens_point) return;
  PathVertex lens;
  lens.at = CameraVertex{lens_point->lens_point, lens_point->route};
  lens.packet.wavelengths = from.packet.wavelengths;
  lens.packet.hero = from.packet.hero;
  lens.packet.throughput = SampledSpectrum(1 / lens_point->pdf_position);
  lens.media_front = lens.media_behind = camera_media(plan_, lens_point->lens_point, from.time);
  lens.time = from.time;
  set_joined(i, 0, photon, s);
  joined_.z.insert(joined_.z.begin(), &lens);
  joined_.t = 1;
  add_joined(i, {static_cast<int>(lens_point->film.x), static_cast<int>(lens_point->film.y),
                 lens_point->cos_film, from.time, images_of(*lens_point)});
}

void BidirectionalTracer::merge(std::uint32_t i, std::size_t t) {
  const PathVertex& x = from_camera_.paths()[i].vertices[t - 1];
  shared_subpaths_->find_nearby(point_of(x), nearby_);
  for (const LightSubpaths::Vertex& nearby : nearby_) merge(i, t, nearby);
}

// Merges the last of `t` camera vertices with a vertex of another light subpath.
void BidirectionalTracer::merge(std::uint32_t i, std::size_t t, const LightSubpaths::Vertex& at) {
  const LightSubpaths::Path photon = (*shared_subpaths_)[at.path];
  const PathVertex& x = from_camera_.paths()[i].vertices[t - 1];
  const PathVertex& y = photon.vertices[at.number];
  if (t + at.number > max_vertices_) return;
  const auto& arrived = std::get<SurfaceVertex>(y.at);
  const Imath::V3f from = arrived.frame.to_world(arrived.wo);
  const auto& here = std::get<SurfaceVertex>(x.at);
  const SampledSpectrum f = merged_scattering(here, from, arrived.hit.normal);
  if (f.is_zero()) return;
  set_joined(i, t, photon, at.number);
  joined_.merged = &y;
  joined_.passing_pdf = weights_.passing_pdf_between(x, photon.vertices[at.number - 1]);
  add(i, film_points_[i], std::get<LightVertex>(joined_.z.back()->at).light,
      x.packet.throughput * y.packet.throughput * f * weight(),
      merged_polarisation(here, x.packet.polarisation, from, y.packet.polarisation));
}

LightSubpaths::Path BidirectionalTracer::own_light_subpath(std::uint32_t i) {
  if (shared_subpaths_ == nullptr) return {from_light_.paths()[i].vertices, samples_[i].light};
  const PixelPair& sample = samples_[i];
  return (
      *shared_subpaths_)[static_cast<std::size_t>(sample.y) * static_cast<std::size_t>(scene_.camera.width) +
                         static_cast<std::size_t>(sample.x)];
}

// Sets the current path from the first `t` camera vertices and the first `s` light vertices.
void BidirectionalTracer::set_joined(std::uint32_t i, std::size_t t, const LightSubpaths::Path& photon,
                                     std::size_t s) {
  joined_.merged = nullptr;
  joined_.z.clear();
  for (std::size_t k = 0; k < t; ++k) joined_.z.push_back(&from_camera_.paths()[i].vertices[k]);
  for (std::size_t k = s; k-- > 0;) joined_.z.push_back(&photon.vertices[k]);
  joined_.t = t;
}

// Connects the vertices next to the joint of the current path and adds its contribution.
void BidirectionalTracer::add_joined(std::uint32_t i, const FilmPoint& at) {
  const PathVertex& a = *joined_.z[joined_.t - 1];
  const PathVertex& b = *joined_.z[joined_.t];
  const std::optional<Connection> connection = abbe::connect(scene_, caster_, a, b);
  if (!connection) return;
  joined_.passing_pdf = connection->passing_pdf;
  const PathVertex& light = *joined_.z.back();
  add(i, at, std::get<LightVertex>(light.at).light, connection->contribution * weight(), connection->stokes);
}

// MIS weight of the current path.
float BidirectionalTracer::weight() {
  EndDensities ends = end_densities(plan_, *joined_.z[joined_.z.size() - 2], *joined_.z.back());
  ends.lights_connect_to_camera = probe_;
  ends.lens_connections = probe_ ? 1 : static_cast<float>(plan_.photons);
  if (shared_subpaths_ != nullptr)
    ends.merging = disc_area(shared_subpaths_->radius()) * static_cast<float>(shared_subpaths_->size());
  return joining_weight_ * weights_.weight_of(joined_, ends);
}

// Path tracing has further techniques for light from specular surfaces or media; for such paths the fraction
// is at least 1.
float BidirectionalTracer::path_tracing_fraction() const {
  const auto between = std::span(joined_.z).subspan(1, joined_.z.size() - 2);
  const bool sampled_once =
      between.empty() ||
      (std::holds_alternative<SurfaceVertex>(between.back()->at) &&
       std::none_of(between.begin(), between.end(), [](const PathVertex* vertex) { return vertex->delta; }));
  return sampled_once ? weights_.path_tracing_fraction() : std::max(1.0F, weights_.path_tracing_fraction());
}

// A probe receives each light at its own angle of incidence.
FilmPoint BidirectionalTracer::film_point(std::uint32_t i, std::size_t t, const PathVertex& b) {
  FilmPoint at = film_points_[i];
  const PathVertex& camera = from_camera_.paths()[i].vertices[0];
  if (probe_ && t == 1) at.cos_film = segment_between(camera, b).direction.dot(*normal_of(scene_, camera));
  return at;
}

void BidirectionalTracer::add(std::uint32_t i, const FilmPoint& at, std::uint32_t light,
                              const SampledSpectrum& contribution,
                              const std::optional<StokesSpectrum>& stokes) {
  const bool own = samples_[i].exposes_pixel && at.x == film_points_[i].x && at.y == film_points_[i].y &&
                   at.cos_film == film_points_[i].cos_film && at.images == film_points_[i].images;
  if (own)
    radiance_.add(i, contribution, pointer_to(stokes));
  else
    radiance_.visit(contribution, pointer_to(stokes), [&](const auto& value) { expose(i, at, value); });
  if (!layer_sink_) return;
  const ContributionInfo info{light, static_cast<int>(joined_.z.size()) - 2, path_tracing_fraction()};
  radiance_.visit(contribution, pointer_to(stokes), [&](const auto& value) {
    expose(i, at, value, [&](const FilmPoint& pixel, std::span<const double> values) {
      layer_sink_(first_ + i, pixel, info, values);
    });
  });
}

template <typename Contribution>
void BidirectionalTracer::expose(std::uint32_t i, const FilmPoint& at, const Contribution& contribution) {
  expose(i, at, contribution, [&](const FilmPoint& pixel, std::span<const double> values) {
    (*deposit_)(first_ + i, pixel, values);
  });
}

template <typename Contribution, typename DepositAt>
void BidirectionalTracer::expose(std::uint32_t i, const FilmPoint& at, const Contribution& contribution,
                                 DepositAt deposit) {
  const SampledWavelengths& wavelengths = from_camera_.paths()[i].packet.wavelengths;
  response_.expose(at, wavelengths,
                   apply_shutter(scene_.shutter, at, contribution) *
                       SampledSpectrum(static_cast<float>(scene_.exposure_s)),
                   deposit);
}

}  // namespace abbe
