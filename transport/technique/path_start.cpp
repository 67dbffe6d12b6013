#include "materials/bsdf/warp.h"
#include "scene/polarisation_need.h"
#include "transport/path/polarised_ends.h"
#include "transport/technique/path.h"
#include "transport/technique/start_matter.h"

// How paths leave the film, a lens that parts their lanes, or a meter.

namespace abbe {

// Rays through a lens that displaces lanes are traced several at once.
void PathTracer::start(std::span<const PixelSample> samples) {
  if (camera_.displaces_lanes) return start_together(samples);
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    CameraPath& path = walks_.paths().emplace_back(samples[i].sampler, i);
    const auto [film, lens, wavelengths_nm, hero, time] = ask(samples[i], path);
    if (start(samples[i], sample_ray(scene_.camera, film, lens, wavelengths_nm, hero, time), path))
      walks_.going().push_back(i);
  }
}

void PathTracer::start_together(std::span<const PixelSample> samples) {
  std::vector<CameraPath>& paths = walks_.paths();
  asked_.clear();
  rays_.resize(samples.size());
  images_.resize(samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i)
    asked_.push_back(ask(samples[i], paths.emplace_back(samples[i].sampler, i)));
  sample_rays(scene_.camera, asked_, rays_);
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    if (start(samples[i], rays_[i], paths[i])) walks_.going().push_back(i);
    if (ghosts_.any())
      ghosts_.connect(samples[i].sampler, paths[i].packet.wavelengths, first_ + i, *deposit_, apart_);
  }
}

CameraSample PathTracer::ask(const PixelSample& sample, CameraPath& path) const {
  const std::array<float, 4> film = sample.sampler.group(kFilmGroup);
  const std::array<float, 4> lens =
      camera_.depth_of_field ? sample.sampler.group(kLensGroup) : std::array<float, 4>{};
  path.packet = draw_packet(plan_.wavelengths_at(sample.x, sample.y), film[2]);
  return {{static_cast<float>(sample.x) + film[0], static_cast<float>(sample.y) + film[1]},
          {lens[0], lens[1]},
          path.lambda_nm(),
          path.packet.hero,
          scene_.shutter.draw(sample.y, film[kTimeNumber])};
}

bool PathTracer::start(const PixelSample& sample, const CameraRay& ray, CameraPath& path) {
  path.ray = ray.ray;
  path.route = ray.route;
  if (carries_polarisation_)
    path.packet.polarisation =
        polarisation_of_film(scene_, light_travels(path.ray.direction, kMode), ray.ray.time, images_of(ray));
  path.at = {sample.x, sample.y, ray.cos_film, ray.ray.time};
  path.scale = ray.weight * static_cast<float>(scene_.exposure_s * scene_.shutter.mean());
  enter_camera_matter(plan_, path);
  if (camera_.displaces_lanes && !part_lanes(ray, path)) return false;
  if (!camera_.meter_acceptance) return true;
  const Imath::V3f normal = meter_normal(scene_.camera, path.ray.origin);
  path.events = kMeterEvent;
  // The camera's ray starts beside the meter already, and rays that leave a surface are moved off it again.
  const Imath::V3f point = offset_point(path.ray.origin, normal, -normal);
  const bool leaves = walks_.leave(*this, path, SurfaceVertex::meter(point, normal));
  path.at.cos_film = path.ray.direction.dot(normal);
  return leaves;
}

// Each lane falls where the lens takes it, balanced with the others that would have drawn the ray, and the
// time of it. Whether any light comes through at all.
[[gnu::noinline]] bool PathTracer::part_lanes(const CameraRay& ray, CameraPath& path) {
  if (ray.weight.is_zero()) return false;
  images_[path.path] = *ray.images;
  path.at.images = &images_[path.path];
  const SampledSpectrum openings = openings_over_own(scene_.shutter, path.at);
  path.scale *= openings;
  path.packet.lane_pdf = ray.lane_pdf * openings;
  path.eta_scale = path.packet.lane_pdf.max();
  return !openings.is_zero();
}

[[gnu::noinline]] BsdfSample PathTracer::leave_meter(const Imath::V2f& u) const {
  const float acceptance = *camera_.meter_acceptance;
  const Imath::V3f wi = cosine_cone(u, acceptance);
  return BsdfSample{.wi = wi, .weight = SampledSpectrum(1.0F), .pdf = wi.z / disc_area(acceptance)};
}

// A meter counts what comes within an angle as a white surface would what comes from its hemisphere: that is
// over pi sin^2, and so is the density of its directions, which `leave_meter` draws by the cosine.
bool PathTracer::accepted(const Imath::V3f& direction, const Imath::V3f& normal,
                          SampledSpectrum& contribution, SampledSpectrum& pdf) const {
  const float acceptance = *camera_.meter_acceptance;
  if (!within_acceptance(acceptance, normal, direction)) return false;
  if (!narrow_) return true;
  contribution *= 1 / (acceptance * acceptance);
  if (!pdf.is_zero()) pdf = SampledSpectrum(normal.dot(direction) / disc_area(acceptance));
  return true;
}

}  // namespace abbe
