#include "materials/bsdf/warp.h"
#include "scene/scene_features.h"
#include "transport/path/polarised_ends.h"
#include "transport/technique/path.h"
#include "transport/technique/start_media.h"

// Path tracing: starts of paths at the film, a dispersing lens, or a probe.

namespace abbe {

// Rays through a lens that disperses wavelengths are traced several at once.
void PathTracer::start(std::span<const PixelSample> samples) {
  if (camera_.displaces_wavelengths) return start_batch(samples);
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    CameraPath& path = batch_.paths().emplace_back(samples[i].sampler, i);
    const auto [film, lens, wavelengths_nm, hero, time] = draw_camera_sample(samples[i], path);
    if (start(samples[i], sample_ray(scene_.camera, film, lens, wavelengths_nm, hero, time), path))
      batch_.active().push_back(i);
  }
}

void PathTracer::start_batch(std::span<const PixelSample> samples) {
  std::vector<CameraPath>& paths = batch_.paths();
  camera_samples_.clear();
  rays_.resize(samples.size());
  images_.resize(samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i)
    camera_samples_.push_back(draw_camera_sample(samples[i], paths.emplace_back(samples[i].sampler, i)));
  sample_rays(scene_.camera, camera_samples_, rays_);
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    if (start(samples[i], rays_[i], paths[i])) batch_.active().push_back(i);
    if (ghosts_.any())
      ghosts_.connect(samples[i].sampler, paths[i].packet.wavelengths, first_ + i, *deposit_, layer_sink_);
  }
}

CameraSample PathTracer::draw_camera_sample(const PixelSample& sample, CameraPath& path) const {
  const std::array<float, 4> film = sample.sampler.group(kFilmGroup);
  const std::array<float, 4> lens =
      camera_.depth_of_field ? sample.sampler.group(kLensGroup) : std::array<float, 4>{};
  path.packet = draw_packet(plan_.wavelengths_at(sample.x, sample.y), film[2]);
  return {{static_cast<float>(sample.x) + film[0], static_cast<float>(sample.y) + film[1]},
          {lens[0], lens[1]},
          path.lambda_nm(),
          path.packet.hero,
          scene_.shutter.sample(sample.y, film[kTimeIndex])};
}

bool PathTracer::start(const PixelSample& sample, const CameraRay& ray, CameraPath& path) {
  path.ray = ray.ray;
  path.route = ray.route;
  if (carries_polarisation_)
    path.packet.polarisation =
        polarisation_of_film(scene_, light_travels(path.ray.direction, kMode), ray.ray.time, images_of(ray));
  path.at = {sample.x, sample.y, ray.cos_film, ray.ray.time};
  path.scale = ray.weight * static_cast<float>(scene_.exposure_s * scene_.shutter.mean());
  enter_camera_media(plan_, path);
  if (camera_.displaces_wavelengths && !displace_wavelengths(ray, path)) return false;
  if (!camera_.probe_acceptance) return true;
  const Imath::V3f normal = probe_normal(scene_.camera, path.ray.origin);
  path.depth = kProbeDepth;
  // The camera's ray starts offset from the probe already, and rays that leave a surface are offset again.
  const Imath::V3f point = offset_point(path.ray.origin, normal, -normal);
  const bool active = batch_.scatter_at(*this, path, SurfaceVertex::at_probe(point, normal));
  path.at.cos_film = path.ray.direction.dot(normal);
  return active;
}

// Each wavelength has its own film position. Weights are balanced over the wavelengths' pdfs of the ray and
// its time. Returns false if the shutter is closed for all of them.
[[gnu::noinline]] bool PathTracer::displace_wavelengths(const CameraRay& ray, CameraPath& path) {
  if (ray.weight.is_zero()) return false;
  images_[path.index] = *ray.images;
  path.at.images = &images_[path.index];
  const SampledSpectrum openings = relative_shutter_weights(scene_.shutter, path.at);
  path.scale *= openings;
  path.packet.lane_pdf = ray.lane_pdf * openings;
  path.eta_scale = path.packet.lane_pdf.max();
  return !openings.is_zero();
}

[[gnu::noinline]] BsdfSample PathTracer::sample_probe_direction(const Imath::V2f& u) const {
  const float acceptance = *camera_.probe_acceptance;
  const Imath::V3f wi = cosine_cone(u, acceptance);
  return BsdfSample{.wi = wi, .weight = SampledSpectrum(1.0F), .pdf = wi.z / disc_area(acceptance)};
}

// A probe with an acceptance cone responds like a white surface to light from its hemisphere: the cosine over
// pi sin^2. `sample_probe_direction` samples the cosine, so the pdf is the same.
bool PathTracer::apply_acceptance(const Imath::V3f& direction, const Imath::V3f& normal,
                                  SampledSpectrum& contribution, SampledSpectrum& pdf) const {
  const float acceptance = *camera_.probe_acceptance;
  if (!within_acceptance(acceptance, normal, direction)) return false;
  if (!restricts_acceptance_) return true;
  contribution *= 1 / (acceptance * acceptance);
  if (!pdf.is_zero()) pdf = SampledSpectrum(normal.dot(direction) / disc_area(acceptance));
  return true;
}

}  // namespace abbe
