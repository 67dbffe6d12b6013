#include "transport/technique/light.h"

#include <array>
#include <cmath>

#include "transport/path/mis_weight.h"
#include "transport/path/polarised_paths.h"

namespace abbe {
namespace {

std::optional<Opening> probe_opening(const Camera& camera) {
  return is_probe(camera) ? traits(camera).opening : std::nullopt;
}

std::optional<Ball> ball_around(const Camera& meter, std::optional<double> radius) {
  return radius ? std::optional(Ball{center(meter), *radius}) : std::nullopt;
}

// Connection of a ray that enters a ball around a probe or starts within it, whatever its direction. Within
// the ball the point is one offset length away, because a segment of length 0 has no direction.
std::optional<CameraConnection> connection_into(const Ball& ball, const Camera& meter, const Ray& light) {
  const Ray at_rest = ray_in_rest_frame(meter, light);
  const bool within = (Imath::V3d(at_rest.origin) - ball.center).length() <= ball.radius;
  const std::optional<double> distance = within ? static_cast<double>(offset_length(light.origin))
                                                : crossing(SphereSide{{ball.center, ball.radius}}, at_rest);
  if (!distance) return std::nullopt;
  const Imath::V3f point(Imath::V3d(light.origin) + Imath::V3d(light.direction) * *distance);
  return CameraConnection{{0, 0}, point, 1, SampledSpectrum(1.0F), 1};
}

}  // namespace

LightTracer::LightTracer(const Plan& plan, RayCaster& caster, double sample_fraction,
                         std::optional<double> ball_radius)
    : plan_(plan),
      scene_(plan.scene),
      caster_(caster),
      scale_(static_cast<float>(sample_fraction * plan.scene.exposure_s)),
      sole_technique_(!traces(plan.techniques, TracedPaths::camera)),
      probe_opening_(probe_opening(plan.scene.camera)),
      ball_(ball_around(plan.scene.camera, ball_radius)),
      response_(film_response_of(plan.scene)),
      measures_polarisation_(measures_polarisation(plan.scene)),
      batch_(plan.scene, caster) {}

// The estimate of a film value is a sum over photons y_0 y_1 ... of power Phi of
//     sum_n w_n Phi [T_n / P_n] f cos W.
// T_n is the throughput up to y_n, P_n its pdf, and W the camera's response to intensity towards its lens.
// Each vertex is connected to the lens, and `lane_balance` weights the wavelengths. A probe has no lens. For
// a photon that hits it after y_n the term is w_n Phi [T_(n+1) / P_(n+1)] W, where W is the response to
// incident power. The time of a photon is uniform over the whole exposure, and W includes `Shutter::weight`
// of the film row at that time.
void LightTracer::trace(std::span<const Sampler> photons, const Deposit& deposit) {
  deposit_ = &deposit;
  starts_.assign(photons.size(), {});
  std::vector<LightPath>& paths = batch_.paths();
  paths.clear();
  for (std::uint32_t i = 0; i < photons.size(); ++i) {
    LightPath& path = paths.emplace_back(photons[i], i);
    starts_[i] = start_photon(plan_, caster_, path);
    path.power = path.packet.throughput.max();
    if (path.packet.throughput.is_zero()) continue;
    if (probe_opening_ && sole_technique_) record_probe_hit(path, 0);
    batch_.active().push_back(i);
  }
  batch_.run(*this);
}

void LightTracer::connect(LightPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u) {
  if (!owns(path)) return;
  const std::optional<CameraConnection> lens =
      sample_towards(scene_.camera, vertex.hit.point, {u[0], u[1]}, path.lambda_nm(), path.ray.time);
  if (!lens) return;
  const Imath::V3f towards = (lens->lens_point - vertex.hit.point).normalized();
  const auto [wi, f, crosses] = vertex.eval_towards(towards, kMode);
  if (f.is_zero()) return;
  std::optional<StokesSpectrum> measured;
  if (path.packet.polarisation) measured = measured_stokes(path, vertex.mueller(wi, false), towards, *lens);
  MediumState crossed;
  if (crosses) crossed.enter(scene_, vertex.media_behind(scene_, path.media.stack), path.lambda_nm());
  connect_to(path, path.depth + 1, *lens, f * std::abs(wi.z), vertex.spawn_ray(towards, path.ray.time),
             crosses ? crossed : path.media, measured);
}

void LightTracer::connect_in_medium(LightPath& path, const PhaseFunction& phase,
                                    const std::array<float, 4>& u) {
  const std::optional<CameraConnection> lens =
      sample_towards(scene_.camera, path.ray.origin, {u[0], u[1]}, path.lambda_nm(), path.ray.time);
  if (!lens) return;
  const Imath::V3f towards = (lens->lens_point - path.ray.origin).normalized();
  std::optional<StokesSpectrum> measured;
  if (path.packet.polarisation)
    measured = measured_stokes(path, mueller(phase, path.ray.direction, towards), towards, *lens);
  connect_to(path, path.depth + 1, *lens, SampledSpectrum(pdf(phase, path.ray.direction, towards)),
             ray_at(path.ray.origin, towards, path.ray.time), path.media, measured);
}

// Stokes vector that the film measures of an event with this matrix in the direction `towards`, relative to
// an unpolarised estimate.
StokesSpectrum LightTracer::measured_stokes(const LightPath& path, const std::optional<MuellerMatrix>& matrix,
                                            const Imath::V3f& towards, const CameraConnection& lens) const {
  const Polarisation light =
      path.packet.polarisation->through(matrix, light_travels(path.ray.direction, kMode), kMode);
  return polarisation_of_film(scene_, towards, path.ray.time, images_of(lens)).of(light, towards);
}

// Queues a connection of a photon at the given depth. `scattered` is the fraction of its power that leaves
// along `ray` towards the lens [1/sr], or 1 for a probe hit. `measured` is the polarised estimate relative to
// an unpolarised one, if polarisation is carried.
void LightTracer::connect_to(const LightPath& path, int depth, const CameraConnection& lens,
                             const SampledSpectrum& scattered, const Ray& ray, const MediumState& media,
                             const std::optional<StokesSpectrum>& measured) {
  SampledSpectrum contribution =
      scattered * (path.packet.throughput * (lens.weight * lane_balance(path.packet.lane_pdf)));
  const float distance = (lens.lens_point - ray.origin).length();
  if (batch_.has_free_paths())
    through_media_.push_back({ray, media, distance});
  else
    media.medium.attenuate(contribution, distance);
  connections_.push_back(
      {path.index,
       depth,
       contribution,
       {static_cast<int>(lens.film.x), static_cast<int>(lens.film.y), lens.cos_film, ray.time},
       path.branch});
  if (lens.images) images_.push_back(*lens.images);
  if (measured) measured_stokes_.push_back(*measured);
  shadow_rays_.push_back(shadow_ray_between(ray.origin, lens.lens_point, ray.time));
}

// Traces the queued shadow rays and exposes the unoccluded connections.
void LightTracer::resolve_connections() {
  occluded_.resize(shadow_rays_.size());
  caster_.occluded(shadow_rays_, occluded_);
  for (std::size_t i = 0; i < shadow_rays_.size(); ++i) {
    if (occluded_[i] != 0) continue;
    Connection& connection = connections_[i];
    if (!through_media_.empty()) {
      const auto& [ray, media, distance] = through_media_[i];
      const SampledSpectrum& wavelengths_nm = batch_.paths()[connection.path].lambda_nm();
      connection.contribution *=
          transmission(scene_, caster_, ray, media, wavelengths_nm, distance).transmittance;
    }
    if (!images_.empty()) connection.at.images = &images_[i];
    with_measurement(measures_polarisation_, connection.contribution,
                     measured_stokes_.empty() ? nullptr : &measured_stokes_[i],
                     [&](const auto& light) { expose(connection, light); });
  }
  connections_.clear();
  images_.clear();
  measured_stokes_.clear();
  through_media_.clear();
  shadow_rays_.clear();
}

template <typename Contribution>
void LightTracer::expose(const Connection& connection, Contribution contribution) {
  contribution *= SampledSpectrum(scale_);
  response_.expose(connection.at, batch_.paths()[connection.path].packet.wavelengths,
                   apply_shutter(scene_.shutter, connection.at, contribution),
                   [&](const FilmPoint& at, std::span<const double> values) {
                     (*deposit_)(connection.path, at, values);
                     if (layer_sink_)
                       layer_sink_(connection.path, at,
                                   {starts_[connection.path].light, connection.depth, 1, connection.branch},
                                   values);
                   });
}

std::optional<CameraConnection> LightTracer::probe_connection(const LightPath& path) const {
  return ball_ ? connection_into(*ball_, scene_.camera, path.ray)
               : connection_through(scene_.camera, *probe_opening_, path.ray, path.lambda_nm());
}

void LightTracer::record_probe_hit(const LightPath& path, int depth) {
  const auto lens = probe_connection(path);
  if (!lens) return;
  connect_to(path, depth, *lens, SampledSpectrum(1.0F), path.ray, path.media,
             measured_on_film(scene_, path.packet, path.ray.direction, path.ray.time, images_of(*lens)));
}

}  // namespace abbe
