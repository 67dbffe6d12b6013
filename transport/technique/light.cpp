#include "transport/technique/light.h"

#include <array>
#include <cmath>

#include "transport/path/mis_weight.h"
#include "transport/path/polarised_ends.h"

namespace abbe {
namespace {

std::optional<Opening> opening_of_meter(const Camera& camera) {
  return is_meter(camera) ? traits(camera).opening : std::nullopt;
}

std::optional<Sphere> ball_around(const Camera& meter, std::optional<double> radius) {
  return radius ? std::optional(Sphere{middle(meter), *radius}) : std::nullopt;
}

}  // namespace

LightTracer::LightTracer(const Plan& plan, RayCaster& caster, double share, std::optional<double> ball_radius)
    : plan_(plan),
      scene_(plan.scene),
      caster_(caster),
      scale_(static_cast<float>(share * plan.scene.exposure_s)),
      alone_(!uses(plan.techniques, Technique::path)),
      meter_(opening_of_meter(plan.scene.camera)),
      ball_(ball_around(plan.scene.camera, ball_radius)),
      response_(film_response_of(plan.scene)),
      measures_polarisation_(measures_polarisation(plan.scene)),
      walks_(plan.scene, caster) {}

// The estimate of a film value is, over photons y_0 y_1 ... of power Phi from the lights,
//     sum_n w_n Phi [T_n / P_n] f cos W,
// T_n being the throughput up to y_n and P_n its density, and W what the camera makes of intensity towards
// its lens: each vertex is connected to the lens, and `mis_weight` balances the lanes. A meter has no lens:
// of a photon that runs into it after y_n the term is w_n Phi [T_(n+1) / P_(n+1)] W, W being what it makes of
// power that comes in. A photon has a time of the whole span in which the film is exposed, and W contains
// what the shutter of the row that it comes to passes then (`Shutter::weight`).
void LightTracer::trace(std::span<const Sampler> photons, const Deposit& deposit) {
  deposit_ = &deposit;
  starts_.assign(photons.size(), {});
  std::vector<LightPath>& paths = walks_.paths();
  paths.clear();
  for (std::uint32_t i = 0; i < photons.size(); ++i) {
    LightPath& path = paths.emplace_back(photons[i], i);
    starts_[i] = start_photon(plan_, caster_, path);
    path.power = path.packet.throughput.max();
    if (path.packet.throughput.is_zero()) continue;
    if (meter_ && alone_) run_into_meter(path, 0);
    walks_.going().push_back(i);
  }
  walks_.run(*this);
}

void LightTracer::connect(LightPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u) {
  if (!owned(path)) return;
  const std::optional<CameraConnection> lens =
      sample_towards(scene_.camera, vertex.hit.point, {u[0], u[1]}, path.lambda_nm(), path.ray.time);
  if (!lens) return;
  const Imath::V3f towards = (lens->lens_point - vertex.hit.point).normalized();
  const auto [wi, f, crosses] = vertex.towards(towards, kMode);
  if (f.is_zero()) return;
  std::optional<StokesSpectrum> arrives;
  if (path.packet.polarisation) arrives = arriving(path, vertex.mueller(wi, false), towards, *lens);
  Surroundings crossed;
  if (crosses) crossed.enter(scene_, vertex.behind(scene_, path.around.inside), path.lambda_nm());
  connect_to(path, path.events + 1, *lens, f * std::abs(wi.z), vertex.leave(towards, path.ray.time),
             crosses ? crossed : path.around, arrives);
}

void LightTracer::connect_within(LightPath& path, const PhaseFunction& phase, const std::array<float, 4>& u) {
  const std::optional<CameraConnection> lens =
      sample_towards(scene_.camera, path.ray.origin, {u[0], u[1]}, path.lambda_nm(), path.ray.time);
  if (!lens) return;
  const Imath::V3f towards = (lens->lens_point - path.ray.origin).normalized();
  std::optional<StokesSpectrum> arrives;
  if (path.packet.polarisation)
    arrives = arriving(path, mueller(phase, path.ray.direction, towards), towards, *lens);
  connect_to(path, path.events + 1, *lens, SampledSpectrum(pdf(phase, path.ray.direction, towards)),
             ray_at(path.ray.origin, towards, path.ray.time), path.around, arrives);
}

// What an event of that matrix sends along `towards`, to the film, over what it would send were all of it
// unpolarised.
StokesSpectrum LightTracer::arriving(const LightPath& path, const std::optional<MuellerMatrix>& matrix,
                                     const Imath::V3f& towards, const CameraConnection& lens) const {
  const Polarisation light =
      path.packet.polarisation->through(matrix, light_travels(path.ray.direction, kMode), kMode);
  return polarisation_of_film(scene_, towards, path.ray.time, images_of(lens)).of(light, towards);
}

// After so many events `scattered` is the share of the photon's power that leaves along `ray`, towards the
// lens [1/sr], or all of it, into a meter, were it unpolarised, and `arrives` how it is polarised there,
// where that is carried.
void LightTracer::connect_to(const LightPath& path, int events, const CameraConnection& lens,
                             const SampledSpectrum& scattered, const Ray& ray, const Surroundings& around,
                             const std::optional<StokesSpectrum>& arrives) {
  SampledSpectrum contribution =
      scattered * (path.packet.throughput * (lens.weight * lane_balance(path.packet.lane_pdf)));
  const float distance = (lens.lens_point - ray.origin).length();
  if (walks_.has_free_paths())
    through_.push_back({ray, around, distance});
  else
    around.medium.attenuate(contribution, distance);
  connections_.push_back(
      {path.path,
       events,
       contribution,
       {static_cast<int>(lens.film.x), static_cast<int>(lens.film.y), lens.cos_film, ray.time},
       path.branch});
  if (lens.images) images_.push_back(*lens.images);
  if (arrives) arrives_.push_back(*arrives);
  ways_.push_back(way_between(ray.origin, lens.lens_point, ray.time));
}

void LightTracer::resolve_connections() {
  blocked_.resize(ways_.size());
  caster_.occluded(ways_, blocked_);
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    if (blocked_[i] != 0) continue;
    Connection& found = connections_[i];
    if (!through_.empty()) {
      const auto& [ray, around, distance] = through_[i];
      const SampledSpectrum& wavelengths_nm = walks_.paths()[found.path].lambda_nm();
      found.contribution *=
          transmission(scene_, caster_, ray, around, wavelengths_nm, distance).transmittance;
    }
    if (!images_.empty()) found.at.images = &images_[i];
    with_seen(measures_polarisation_, found.contribution, arrives_.empty() ? nullptr : &arrives_[i],
              [&](const auto& light) { expose(found, light); });
  }
  connections_.clear();
  images_.clear();
  arrives_.clear();
  through_.clear();
  ways_.clear();
}

template <typename Contribution>
void LightTracer::expose(const Connection& found, Contribution contribution) {
  contribution *= SampledSpectrum(scale_);
  response_.expose(
      found.at, walks_.paths()[found.path].packet.wavelengths,
      let_through(scene_.shutter, found.at, contribution),
      [&](const FilmPoint& at, std::span<const double> values) {
        (*deposit_)(found.path, at, values);
        if (apart_)
          apart_(found.path, at, {starts_[found.path].light, found.events, 1, found.branch}, values);
      });
}

}  // namespace abbe
