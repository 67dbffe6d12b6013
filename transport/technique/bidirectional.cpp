#include "transport/technique/bidirectional.h"

#include <algorithm>

#include "materials/bsdf/warp.h"
#include "transport/path/connect.h"
#include "transport/path/dimensions.h"
#include "transport/path/merge.h"
#include "transport/path/polarised_ends.h"
#include "transport/technique/start_matter.h"
#include "transport/technique/subpaths.h"

namespace abbe {
namespace {

// The numbers for connections of the vertex after `i` others.
std::array<float, 4> connection_numbers(const Sampler& sampler, std::size_t i) {
  return sampler.group(scattering_group(static_cast<int>(i) - 1) + 1);
}

}  // namespace

BidirectionalTracer::BidirectionalTracer(const Plan& plan, RayCaster& caster)
    : plan_(plan),
      scene_(plan.scene),
      caster_(caster),
      meter_(is_meter(plan.scene.camera)),
      most_vertices_(static_cast<std::size_t>(most_events(plan.scene.render)) + 2),
      response_(film_response_of(plan.scene)),
      from_camera_(plan.scene, caster),
      from_light_(plan.scene, caster),
      ghosts_(plan, caster),
      found_(plan.scene),
      weights_(plan.scene, caster) {}

void BidirectionalTracer::trace(std::span<const PixelPair> samples, const LightPaths& from_lights,
                                const Deposit& deposit) {
  from_lights_ = &from_lights;
  trace(samples, deposit);
  from_lights_ = nullptr;
}

void BidirectionalTracer::trace(std::span<const PixelPair> samples, const Deposit& deposit) {
  deposit_ = &deposit;
  for (std::size_t first = 0; first < samples.size(); first += kPathsTogether)
    trace_together(samples.subspan(first, std::min<std::size_t>(kPathsTogether, samples.size() - first)),
                   static_cast<std::uint32_t>(first));
}

// The estimate of a film value is, over paths x_0 x_1 ... from the camera and y_0 y_1 ... from a light,
//     sum_st w_st [T_x / P_x] [T_y / P_y] f_x f_y G T,
// the throughputs up to x_{t-1} and y_{s-1} over their densities, times what joins the two (`connect`); for
// s = 0 x_t is on a light by itself, for s = 1 a point of a light is drawn for x_{t-1} instead of y_0, and
// for t = 1 a point of the lens for y_{s-1}, which may expose another pixel. Merging x with y within r adds
//     sum_y w [T_x / P_x] [T_y / P_y] f / (pi r^2 N).
// `StrategyWeights` balances all of them. Both paths have one time, drawn from the whole span in which the
// film is exposed, so that they may be joined, and what they bring counts `Shutter::weight` of the row it
// comes to then, whichever strategy brought it: the balance is that of the same path at one time.
void BidirectionalTracer::trace_together(std::span<const PixelPair> samples, std::uint32_t first) {
  first_ = first;
  samples_ = samples;
  from_camera_.paths().clear();
  from_light_.paths().clear();
  at_.assign(samples.size(), {});
  images_.resize(samples.size());
  found_.reset(samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    const PixelPair& sample = samples[i];
    RecordedPath& eye = from_camera_.paths().emplace_back(sample.camera, i);
    const std::array<float, 4> film = sample.camera.group(kFilmGroup);
    const float time = from_lights_ == nullptr ? film[kTimeNumber] : from_lights_->time();
    if (from_lights_ == nullptr) {
      RecordedPath& photon = from_light_.paths().emplace_back(sample.light, i);
      photon.packet = draw_packet(plan_.wavelengths, film[2]);
      eye.packet = photon.packet;
      start_from_light(plan_, caster_, time, photon);
    } else {
      eye.packet = from_lights_->packet();
    }
    if (!sample.seen) continue;
    at_[i] = start_from_camera(plan_, sample.x, sample.y, time, eye, images_[i]);
    if (ghosts_.any()) ghosts_.connect(sample.camera, eye.packet.wavelengths, first_ + i, *deposit_, apart_);
  }
  from_camera_.run();
  from_light_.run();
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    join(i);
    if (samples[i].seen) found_.tell(i, [&](const auto& found) { expose(i, at_[i], found); });
  }
}

void BidirectionalTracer::join(std::uint32_t i) {
  const RecordedPath& eye = from_camera_.paths()[i];
  const LightPaths::Path photon = own_light_path(i);
  count_ = 1;
  for (const MetLight& met : eye.met) meet(i, met);
  choose_joined(eye.vertices, eye.sampler, of_camera_);
  choose_joined(photon.vertices, photon.sampler, of_light_);
  for (const JoinedVertex& x : of_camera_)
    if (meter_ || x.number > 1) join(i, x);
  for (const JoinedVertex& y : of_light_) {
    if (meter_ || y.number == 1 || y.number >= most_vertices_) continue;
    count_ = y.count;
    connect_to_lens(i, y.number);
  }
}

// A vertex of the camera's path with lights, and with paths from there.
void BidirectionalTracer::join(std::uint32_t i, const JoinedVertex& x) {
  count_ = x.count;
  if (x.number < most_vertices_) connect_to_light(i, x.number);
  for (const JoinedVertex& y : of_light_) {
    if (y.number == 1 || x.number + y.number > most_vertices_) continue;
    count_ = x.count * y.count;
    connect(i, x.number, y.number);
  }
  count_ = x.count;
  const PathVertex& vertex = from_camera_.paths()[i].vertices[x.number - 1];
  if (from_lights_ != nullptr && x.number > 1 && std::holds_alternative<SurfaceVertex>(vertex.at))
    merge(i, x.number);
}

void BidirectionalTracer::meet(std::uint32_t i, const MetLight& met) {
  if (met.after == 1 && on_ghost(from_camera_.paths()[i].vertices.front())) return;  // see `GhostLights`
  set_joined(i, met.after, own_light_path(i), 0);
  joined_.z.push_back(&met.vertex);
  joined_.t = joined_.z.size();
  joined_.passed = SampledSpectrum(1.0F);
  const PathVertex& lit = *joined_.z[met.after - 1];
  const auto& light = std::get<LightVertex>(met.vertex.at);
  const Imath::V3f towards = way_from(lit, met.vertex).direction;
  const PathPacket& packet = met.vertex.packet;
  const Light& emitter = scene_.lights[light.light];
  add(i, at_[i], light.light,
      packet.throughput * emission_from(emitter, towards, packet.wavelengths.lambda_nm) * weight(),
      seen_of(emitter, packet, towards));
}

void BidirectionalTracer::connect_to_light(std::uint32_t i, std::size_t t) {
  const RecordedPath& eye = from_camera_.paths()[i];
  const auto light = light_for(plan_, eye.vertices[t - 1], connection_numbers(eye.sampler, t - 1));
  if (!light) return;
  set_joined(i, t, own_light_path(i), 0);
  joined_.z.push_back(&*light);
  add_joined(i, film_point(i, t, *light));
}

void BidirectionalTracer::connect(std::uint32_t i, std::size_t t, std::size_t s) {
  set_joined(i, t, own_light_path(i), s);
  add_joined(i, film_point(i, t, own_light_path(i).vertices[s - 1]));
}

void BidirectionalTracer::connect_to_lens(std::uint32_t i, std::size_t s) {
  const LightPaths::Path photon = own_light_path(i);
  const PathVertex& from = photon.vertices[s - 1];
  const std::array<float, 4> u = connection_numbers(photon.sampler, s - 1);
  const auto seen = sample_towards(scene_.camera, point_of(from), {u[0], u[1]}, from.lambda_nm(), from.time);
  if (!seen) return;
  PathVertex lens;
  lens.at = CameraVertex{seen->lens_point, seen->route};
  lens.packet.wavelengths = from.packet.wavelengths;
  lens.packet.hero = from.packet.hero;
  lens.packet.throughput = SampledSpectrum(1 / seen->pdf_position);
  lens.inside = lens.beyond = camera_matter(plan_, seen->lens_point, from.time);
  lens.time = from.time;
  set_joined(i, 0, photon, s);
  joined_.z.insert(joined_.z.begin(), &lens);
  joined_.t = 1;
  add_joined(i, {static_cast<int>(seen->film.x), static_cast<int>(seen->film.y), seen->cos_film, from.time,
                 images_of(*seen)});
}

void BidirectionalTracer::merge(std::uint32_t i, std::size_t t) {
  const PathVertex& x = from_camera_.paths()[i].vertices[t - 1];
  from_lights_->near(point_of(x), near_);
  for (const LightPaths::Vertex& near : near_) merge(i, t, near);
}

// The camera's last of `t` vertices with one of another path.
void BidirectionalTracer::merge(std::uint32_t i, std::size_t t, const LightPaths::Vertex& at) {
  const LightPaths::Path photon = (*from_lights_)[at.path];
  const PathVertex& x = from_camera_.paths()[i].vertices[t - 1];
  const PathVertex& y = photon.vertices[at.number];
  if (t + at.number > most_vertices_) return;
  const auto& arrived = std::get<SurfaceVertex>(y.at);
  const Imath::V3f from = arrived.frame.to_world(arrived.wo);
  const auto& here = std::get<SurfaceVertex>(x.at);
  const SampledSpectrum f = merged_scattering(here, from, arrived.hit.normal);
  if (f.is_zero()) return;
  set_joined(i, t, photon, at.number);
  joined_.merged = &y;
  joined_.passed = weights_.passed_between(x, photon.vertices[at.number - 1]);
  add(i, at_[i], std::get<LightVertex>(joined_.z.back()->at).light,
      x.packet.throughput * y.packet.throughput * f * weight(),
      merged_polarisation(here, x.packet.polarisation, from, y.packet.polarisation));
}

LightPaths::Path BidirectionalTracer::own_light_path(std::uint32_t i) {
  if (from_lights_ == nullptr) return {from_light_.paths()[i].vertices, samples_[i].light};
  const PixelPair& sample = samples_[i];
  return (*from_lights_)[static_cast<std::size_t>(sample.y) * static_cast<std::size_t>(scene_.camera.width) +
                         static_cast<std::size_t>(sample.x)];
}

// The first `t` vertices from the camera, and the first `s` from the light.
void BidirectionalTracer::set_joined(std::uint32_t i, std::size_t t, const LightPaths::Path& photon,
                                     std::size_t s) {
  joined_.merged = nullptr;
  joined_.z.clear();
  for (std::size_t k = 0; k < t; ++k) joined_.z.push_back(&from_camera_.paths()[i].vertices[k]);
  for (std::size_t k = s; k-- > 0;) joined_.z.push_back(&photon.vertices[k]);
  joined_.t = t;
}

void BidirectionalTracer::add_joined(std::uint32_t i, const FilmPoint& at) {
  const PathVertex& a = *joined_.z[joined_.t - 1];
  const PathVertex& b = *joined_.z[joined_.t];
  const std::optional<Connection> joint = abbe::connect(scene_, caster_, a, b);
  if (!joint) return;
  joined_.passed = joint->density;
  const PathVertex& light = *joined_.z.back();
  add(i, at, std::get<LightVertex>(light.at).light, joint->contribution * weight(), joint->seen);
}

// Of the joined path; what its ends are drawn by depends on the light and what it lights.
float BidirectionalTracer::weight() {
  EndDensities ends = end_densities(plan_, *joined_.z[joined_.z.size() - 2], *joined_.z.back());
  ends.camera_takes_lights = meter_;
  ends.lens_connections = meter_ ? 1 : static_cast<float>(plan_.photons);
  if (from_lights_ != nullptr)
    ends.merging = disc_area(from_lights_->radius()) * static_cast<float>(from_lights_->size());
  return count_ * weights_.of(joined_, ends);
}

// Path tracing has other ways than these to light that comes through specular matter or is scattered on its
// way, which count as all.
float BidirectionalTracer::by_path_tracing() const {
  const auto between = std::span(joined_.z).subspan(1, joined_.z.size() - 2);
  const bool plain =
      between.empty() ||
      (std::holds_alternative<SurfaceVertex>(between.back()->at) &&
       std::none_of(between.begin(), between.end(), [](const PathVertex* vertex) { return vertex->delta; }));
  return plain ? weights_.by_path_tracing() : std::max(1.0F, weights_.by_path_tracing());
}

// A meter sees each light under an angle of its own.
FilmPoint BidirectionalTracer::film_point(std::uint32_t i, std::size_t t, const PathVertex& b) {
  FilmPoint at = at_[i];
  const PathVertex& camera = from_camera_.paths()[i].vertices[0];
  if (meter_ && t == 1) at.cos_film = way_from(camera, b).direction.dot(*normal_of(scene_, camera));
  return at;
}

void BidirectionalTracer::add(std::uint32_t i, const FilmPoint& at, std::uint32_t light,
                              const SampledSpectrum& contribution,
                              const std::optional<StokesSpectrum>& seen) {
  const bool own = samples_[i].seen && at.x == at_[i].x && at.y == at_[i].y &&
                   at.cos_film == at_[i].cos_film && at.images == at_[i].images;
  if (own)
    found_.add(i, contribution, pointer_to(seen));
  else
    found_.tell(contribution, pointer_to(seen), [&](const auto& brought) { expose(i, at, brought); });
  if (!apart_) return;
  const LightHistory of{light, static_cast<int>(joined_.z.size()) - 2, by_path_tracing()};
  found_.tell(contribution, pointer_to(seen), [&](const auto& brought) {
    expose(i, at, brought, [&](const FilmPoint& pixel, std::span<const double> values) {
      apart_(first_ + i, pixel, of, values);
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
  response_.expose(
      at, wavelengths,
      let_through(scene_.shutter, at, contribution) * SampledSpectrum(static_cast<float>(scene_.exposure_s)),
      deposit);
}

}  // namespace abbe
