#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <ImathBox.h>
#include <ImathVec.h>

#include "materials/material.h"
#include "scene/camera/camera.h"
#include "scene/lights/light.h"
#include "scene/scene_features.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"
#include "scene/shapes/shape_instance.h"
#include "scene/shutter.h"
#include "scene/white.h"
#include "sensor/film/spectral_film.h"
#include "sensor/readout/readout.h"
#include "sensor/response/channel.h"
#include "sensor/response/mosaic.h"

namespace abbe {

/// A colour chart of the scene. Its patches are `patches` quads, from `shapes[first]` on.
struct ChartInstance {
  std::string name;
  std::uint32_t first;
  std::uint32_t patches;
};

/// The integrator that renders the scene.
enum class Integrator {
  automatic,
  path,
  light,
  bdpt,
  photon_map,
  ppm,
  sppm,
  vcm,
  photon_brute,
  adjoint_brute
};
/// Names of the integrators in scenes, commands and films, in the order of the enumeration.
inline constexpr std::array kIntegratorNames{"auto", "path", "light", "bdpt",         "photon-map",
                                             "ppm",  "sppm", "vcm",   "photon-brute", "adjoint-brute"};
/// Name of an integrator.
[[nodiscard]] constexpr const char* integrator_name(Integrator integrator) {
  return kIntegratorNames.at(static_cast<std::size_t>(integrator));
}

/// Settings of the integrators that use photons.
struct PhotonSettings {
  std::optional<std::uint64_t> per_sample = {};  ///< Photons per sample; absent: as many as pixels.
  std::optional<double> radius_m = {};  ///< Initial gathering radius [m]; absent: from the scene's size.
  int nearest = 50;                     ///< Number of nearest photons in a photon map's estimate.
  bool final_gather = false;            ///< True if the photon map is evaluated one bounce later.
};

/// The density with which Integrator::path samples directions after a non-specular event at a surface or
/// probe: that of the BSDF, cos/pi, or uniform. The latter two cover the side of the incoming path. They
/// cover both sides, with half the density, if light may be transmitted.
enum class DirectionSampling { bsdf, cosine, uniform };

/// The sampling techniques by which Integrator::path finds light after such an event or one in a medium: BSDF
/// sampling and light sampling combined by MIS, BSDF sampling alone, or light sampling alone wherever it is
/// possible.
enum class LightStrategy { mis, bsdf, light };

/// Heuristic that combines both techniques [Veach1997, sec. 9.2]: weights in proportion to the densities, or
/// to their squares.
enum class MisHeuristic { balance, power };

/// Sampling of paths by Integrator::path. It changes the noise. It changes the expected value only by the
/// paths that `unsampled_paths` reports.
struct PathSampling {
  DirectionSampling directions = DirectionSampling::bsdf;
  LightStrategy lights = LightStrategy::mis;
  MisHeuristic heuristic = MisHeuristic::balance;

  friend bool operator==(const PathSampling&, const PathSampling&) = default;
};

/// Settings of the render in the scene file.
struct RenderSettings {
  Integrator integrator = Integrator::automatic;
  int samples = 64;  ///< Samples per pixel.
  /// Maximum number of scattering events of a path, at surfaces and in media; 1 is single scattering. Absent:
  /// Russian roulette alone ends paths.
  std::optional<int> max_depth = {};
  int roulette_depth = 4;  ///< Scattering events before Russian roulette; negative: no Russian roulette.
  std::uint64_t seed = 0;
  PhotonSettings photons = {};
  bool consistent = false;  ///< Integrator::automatic may choose biased but consistent integrators.
  /// Paths carry polarisation if it is relevant; otherwise light counts as unpolarised at every event.
  bool polarisation = true;
  PathSampling sampling = {};  ///< For Integrator::path; others require the default.
};

/// Output files that the scene file requests; empty if it requests none.
struct OutputSettings {
  std::filesystem::path image;
  std::filesystem::path display;
  /// Film value displayed as diffuse white. Absent: chosen from the image.
  std::optional<double> display_exposure;
  std::optional<White> white = {};  ///< Absent: chosen from the lights.
};

/// The shapes as Embree geometry.
class Geometry;

/// The intersection of a ray with the scene, in the float coordinates of the render.
struct SurfaceHit {
  Imath::V3f point;
  Imath::V3f normal;  ///< Geometric normal: unit, outward.
  float t;
  std::uint32_t shape;
  std::uint32_t primitive = 0;   ///< Index of the triangle in its mesh.
  float coincidence_radius = 0;  ///< Surfaces within this distance [m] on both sides coincide.
  float retreat_m = 0;  ///< Distance [m] by which a ray that leaves to its incident side starts farther back.
};

/// A ray that leaves the surface in `direction` and starts outside all coincident surfaces.
[[nodiscard]] inline Ray spawn(const SurfaceHit& hit, const Imath::V3f& direction, float time) {
  const float clear = std::copysign(hit.coincidence_radius, hit.normal.dot(direction));
  return spawn(hit.point + hit.normal * clear, hit.normal, direction, time);
}

/// The overload for a path that arrived along the unit direction `from`. A ray that leaves to the side of
/// arrival also starts `retreat_m` farther back. Where surfaces meet, rounding may have exchanged the farther
/// hit and the nearer one, which would put the ray behind the nearer one.
[[nodiscard]] inline Ray spawn(const SurfaceHit& hit, const Imath::V3f& from, const Imath::V3f& direction,
                               float time) {
  Ray ray = spawn(hit, direction, time);
  if (!(hit.normal.dot(from) * hit.normal.dot(direction) > 0)) return ray;
  ray.origin = rounded_back(Imath::V3d(ray.origin) + Imath::V3d(from) * static_cast<double>(hit.retreat_m),
                            -Imath::V3d(from));
  return ray;
}

/// The hits of a ray with coincident surfaces.
struct CoincidentHits {
  static constexpr std::size_t kMaxHits = 16;
  static constexpr double kParallel = 0.999;  ///< Minimum cosine between their normals.
  std::array<SurfaceHit, kMaxHits> at;
  std::size_t count = 0;

  [[nodiscard]] std::span<const SurfaceHit> all() const& { return {at.data(), count}; }
  void all() const&& = delete;  // the span would dangle
};

/// All input of a render. Lengths are in metres and coordinates are recentred to be small: `origin_m` is the
/// position in the scene file that becomes (0, 0, 0).
class Scene {
 public:
  std::vector<ShapeInstance> shapes;
  std::vector<Material> materials;
  std::vector<ChartInstance> charts;
  std::vector<Light> lights;
  Camera camera;
  std::vector<Channel> channels;
  std::optional<Mosaic>
      mosaic;  ///< The channel of each pixel; without a mosaic every pixel has all channels.
  double exposure_s = 1;
  Shutter shutter;  ///< `commit` simplifies it if nothing moves.
  /// Fraction of a pixel's area that is sensitive. The signal of a pixel is its film value times the squared
  /// pixel pitch times this.
  double fill_factor = 1;
  /// Conversion of the film to digital numbers, if the scene has a readout.
  std::optional<Readout> readout;
  /// The bins whose channels `channels` are, if the film records spectral radiance.
  std::optional<SpectralBins> spectral;
  /// Band edges [nm] of the spectral image that the sensor views, if it views one.
  std::vector<double> image_band_edges_nm;
  std::string sensor_text;  ///< The sensor's description, as one line of JSON.
  RenderSettings render;
  OutputSettings output;
  SceneFeatures features;
  Imath::V3d origin_m{0, 0, 0};
  double unit_m = 1;           ///< Metres per scene-file unit.
  Imath::Box3d bounds;         ///< Of all shapes except distant ones, and of a probe with an area.
  double far_threshold_m = 0;  ///< Shapes entirely farther from the camera are distant; see `WorkingRange`.
  std::string sha256;          ///< Hash of the scene file after overrides and of all files that it names.

  [[nodiscard]] std::vector<std::string> channel_names() const;
  /// Names of the film's planes: the channels, or the single plane of a mosaic.
  [[nodiscard]] std::vector<std::string> film_planes() const;

  /// Nearest hit at t in (0, ray.t_max). Rays start where `spawn` puts them, so that no epsilon is needed.
  [[nodiscard]] std::optional<SurfaceHit> intersect(const Ray& ray) const;
  /// The surfaces that coincide at the ray's time with `hit`, the hit of `ray`, which is the first of them.
  /// They are parallel and within `coincidence_tolerance`. Each side of a shape counts once.
  [[nodiscard]] CoincidentHits coincident(const Ray& ray, const SurfaceHit& hit) const;
  /// True if a ray that is transmitted at `hit` in `direction` may start behind an opaque surface.
  /// Floats do not separate the surface from a wall that crosses it or ends at it. Surfaces within
  /// `hit.coincidence_radius` do not count.
  [[nodiscard]] bool transmission_may_leak(const SurfaceHit& hit, const Imath::V3f& direction,
                                           float time) const {
    return shapes[hit.shape].near_wall_bounds.intersects(hit.point) &&
           wall_within_rounding(hit, direction, time);
  }
  /// Distance [m] below which surfaces of the two shapes coincide near `point`. Floats of the size of the
  /// point and of the vertices do not separate them.
  [[nodiscard]] double coincidence_tolerance(const Imath::V3d& point, std::uint32_t shape,
                                             std::uint32_t other) const;
  /// The maximum of this distance over all other shapes.
  [[nodiscard]] double coincidence_tolerance(const Imath::V3d& point, std::uint32_t shape) const;
  /// The maximum of this distance everywhere except at distant shapes.
  [[nodiscard]] double coincidence_tolerance() const;
  /// True if anything except boundaries of media lies between two points that `offset_point` moved off their
  /// surfaces. Exact at both ends, at every angle and distance.
  [[nodiscard]] bool occluded(const Imath::V3f& from, const Imath::V3f& to) const;
  [[nodiscard]] bool occluded(const Ray& ray) const;

  /// Traces many rays, each as if it were alone: the nearest hits, and for shadow rays 1 if anything except
  /// boundaries of media blocks them, otherwise 0.
  void intersect(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits) const;
  void occluded(std::span<const BasicRay<double>> rays, std::span<std::uint8_t> blocked) const;

  /// Traces all the rays again through Embree alone and discards the results, to measure the cost of ray
  /// tracing by itself.
  void replay(std::span<const LoggedRay> rays) const;

  /// Indices of the lights that a ray which leaves the scene may hit: environment lights and suns.
  [[nodiscard]] std::span<const std::uint32_t> background() const { return background_; }

  /// True if the light has a position so distant that its rays are practically parallel.
  [[nodiscard]] bool is_distant(const Light& light) const;

  /// Prepares the scene; call once, after all lists are filled. Builds the acceleration structure, `bounds`,
  /// the working range, the volumes of media, the tables of rough dielectrics in media, the areas of lights,
  /// and `features`. Throws Error{resource} if memory is exhausted.
  void commit();

  [[nodiscard]] std::size_t triangle_count() const;  ///< As rendered: a quad counts as two.
  [[nodiscard]] std::size_t memory_bytes() const;    ///< Memory of the geometry, from Embree and the lists.

 private:
  void measure_working_range();
  void measure_media();
  [[nodiscard]] bool wall_within_rounding(const SurfaceHit& hit, const Imath::V3f& direction,
                                          float time) const;

  std::shared_ptr<const Geometry> geometry_;
  std::vector<std::uint32_t> background_;
  double max_rounding_ = 0;  // largest rounding of the shapes that are not distant
};

/// The nearest hit at t in (t_min, ray.t_max), computed in double precision by each shape's own formula
/// without Embree. Used by `abbe trace`.
struct ExactHit {
  ShapeHit<double> hit;
  std::uint32_t shape;
};
[[nodiscard]] std::optional<ExactHit> intersect_exact(const Scene& scene, const BasicRay<double>& ray,
                                                      double t_min);

/// The material of the shape with that index.
[[nodiscard]] inline const Material& material_of(const Scene& scene, std::uint32_t shape) {
  return scene.materials[scene.shapes[shape].material];
}

}  // namespace abbe
