#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sensor/film/feature_film.h"
#include "transport/path/path_state.h"
#include "transport/path/ray_caster.h"
#include "transport/path/vertex.h"
#include "transport/plan/plan.h"
#include "transport/technique/path.h"

namespace abbe {

/// Receives the feature values of all planes for one sample of a pixel. `values` is valid during the call
/// only.
using FeatureDeposit = std::function<void(const PixelSample& sample, std::span<const double> values)>;

/// First-hit features of pixels, in the order of `feature_planes`; all are 0 if the ray hits nothing. Each
/// sample casts one ray, sampled as for a camera path, however many paths the sample has. Medium
/// boundaries without refraction are crossed; scattering in media is ignored. One instance per thread.
/// - Coverage: 1.
/// - Depth: distance from the plane of the lens or probe along its axis, in the scene file's unit. For a
///   camera without an axis it is the distance along the ray.
/// - Position: the point, in the scene file's unit and coordinates.
/// - Normal: geometric normal of the shape. Shading normal: normal with which the BSDF is evaluated. Both are
///   unit vectors towards the ray's origin.
/// - Albedo, per plane: fraction of the light from there that the surface scatters or transmits, rho(lambda)
///   = integral of f |cos| dw, averaged over wavelength with the channel's |weight|. Each value is an
///   estimate from one sampled event.
/// - Id: index of the shape in `Scene::shapes`, plus 1.
class FeatureTracer {
 public:
  /// `features` are the features to record, each once, in the order of `Feature`. Plan and caster must
  /// outlive the tracer.
  FeatureTracer(const Plan& plan, std::span<const Feature> features, RayCaster& caster);

  /// Casts a ray for each sample and deposits its features. `first` is true for the first sample of each
  /// pixel: only that one records an id, because ids have no mean. All other samples record the id 0. Throws
  /// Error{resource} if more than `MediumStack::kMaxShapes` media nest.
  void trace(std::span<const PixelSample> samples, bool first, const FeatureDeposit& deposit);

 private:
  [[nodiscard]] PathState start(const PixelSample& sample) const;
  [[nodiscard]] bool pass_boundary(PathState& path, SurfaceHit& hit,
                                   std::optional<Interface>& interface) const;
  void record_features(const PixelSample& sample, bool first, const SurfaceHit& hit,
                       const std::optional<Interface>& interface, PathState& path);
  [[nodiscard]] double depth(const SurfaceHit& hit, const Ray& ray) const;
  void add_albedo(const PixelSample& sample, const SurfaceHit& hit, const std::optional<Interface>& interface,
                  PathState& path);
  void add(const Imath::V3d& v) { values_.insert(values_.end(), {v.x, v.y, v.z}); }

  const Plan& plan_;
  const Scene& scene_;
  CameraTraits camera_;
  Camera camera_without_ghosts_;  // for image rays only
  RayCaster& caster_;
  std::vector<Feature> features_;
  std::size_t planes_;
  std::vector<std::vector<double>> responses_;   // per channel: cumulative distribution over wavelength
  std::vector<PathState> paths_;                 // state of each sample of the batch
  std::vector<Ray> rays_;                        // ray of each sample
  std::vector<std::optional<SurfaceHit>> hits_;  // hit of each sample
  Imath::V3d lens_point_{0, 0, 0};               // ray origin of the current sample
  std::vector<double> values_;                   // values of the current sample
};

}  // namespace abbe
