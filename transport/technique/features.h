#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sensor/film/feature_film.h"
#include "transport/path/interface.h"
#include "transport/path/ray_caster.h"
#include "transport/path/walk.h"
#include "transport/plan/plan.h"
#include "transport/technique/path.h"

namespace abbe {

/// Receives the values of all planes of the features that a sample of a pixel shows.
using FeatureDeposit = std::function<void(const PixelSample& sample, std::span<const double> values)>;

/// Tells what samples of pixels see first: the features of the surface that a ray meets which sets out as a
/// path of `PathTracer` would, one in each sample whatever paths it has. Boundaries of matter at which
/// nothing is refracted are passed, and what scatters within matter is not looked at. Serves one thread.
///
/// Depth is the distance from the plane of the lens, or of the meter, along its axis, and position the point,
/// both in units and coordinates of the scene file. The normal is that of the shape, the shading normal that
/// which scattering goes by; both are unit vectors and look to where the ray came from. The albedo of a plane
/// is the share of light from there that the surface scatters or lets through, rho(lambda) = integral of
/// f |cos| dw, averaged over the wavelengths of the channel by the size of its weight. Id is the number of
/// the shape in the scene, from 1.
class FeatureTracer {
 public:
  FeatureTracer(const Plan& plan, std::span<const Feature> features, RayCaster& caster);

  /// Casts a ray for each of the samples. The first of the render alone, `first`, tell what they have met by
  /// its Id, which has no mean; of the others it is 0.
  void trace(std::span<const PixelSample> samples, bool first, const FeatureDeposit& deposit);

 private:
  [[nodiscard]] Walk start(const PixelSample& sample) const;
  [[nodiscard]] bool pass_boundary(Walk& walk, SurfaceHit& hit, std::optional<Interface>& met) const;
  void look(const PixelSample& sample, bool first, const SurfaceHit& hit, const std::optional<Interface>& met,
            Walk& walk);
  [[nodiscard]] double depth(const SurfaceHit& hit, const Ray& ray) const;
  void add_albedo(const PixelSample& sample, const SurfaceHit& hit, const std::optional<Interface>& met,
                  Walk& walk);
  void add(const Imath::V3d& v) { values_.insert(values_.end(), {v.x, v.y, v.z}); }

  const Plan& plan_;
  const Scene& scene_;
  CameraTraits camera_;
  Camera of_image_;  // without its ghosts
  RayCaster& caster_;
  std::vector<Feature> features_;
  std::size_t planes_;
  std::vector<std::vector<double>> responses_;   // of each channel, a cumulative distribution over nanometres
  std::vector<Walk> walks_;                      // of the samples under way,
  std::vector<Ray> rays_;                        // their rays,
  std::vector<std::optional<SurfaceHit>> hits_;  // and what they meet
  Imath::V3d lens_point_{0, 0, 0};               // of one sample,
  std::vector<double> values_;                   // and what it shows
};

}  // namespace abbe
