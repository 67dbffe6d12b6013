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
#include "scene/integrators.h"
#include "scene/lights/light.h"
#include "scene/scene_features.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"
#include "scene/shutter.h"
#include "scene/white.h"
#include "sensor/film/spectral_film.h"
#include "sensor/readout/readout.h"
#include "sensor/response/channel.h"
#include "sensor/response/mosaic.h"

namespace abbe {

/// A colour chart of the scene. Its patches are `patches` consecutive quads, from `Scene::shapes[first]` on.
struct ChartInstance {
  std::string name;
  std::uint32_t first;
  std::uint32_t patches;
};

/// Settings of the integrators that use photons.
struct PhotonSettings {
  std::optional<std::uint64_t> per_sample = {};  ///< Photons per sample; absent: as many as pixels.
  std::optional<double> radius_m = {};  ///< Initial gathering radius [m]; absent: from the scene's size.
  int nearest = 50;                     ///< Number of photons in an estimate with `Merging::nearest`.
  bool final_gather = false;            ///< True if such an estimate is made one bounce later.
};

/// The density with which path tracing samples directions after a non-specular event at a surface or
/// probe [1/sr]: that of the BSDF, cos/pi, or uniform. The latter two cover the side of the incoming path.
/// They cover both sides, with half the density, if light may be transmitted.
enum class DirectionSampling { bsdf, cosine, uniform };

/// The sampling techniques by which path tracing finds light after such an event or one in a medium: BSDF
/// sampling and light sampling combined by MIS, BSDF sampling alone, or light sampling alone wherever it is
/// possible.
enum class LightStrategy { mis, bsdf, light };

/// Heuristic that combines both techniques [Veach1997, sec. 9.2]: weights in proportion to the densities, or
/// to their squares.
enum class MisHeuristic { balance, power };

/// Sampling of paths by path tracing. It changes the noise. It changes the expected value only by the
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
  std::uint64_t seed = 0;  ///< Equal seeds give equal random numbers.
  PhotonSettings photons = {};
  bool consistent = false;  ///< Integrator::automatic may choose biased but consistent integrators.
  /// Paths carry polarisation if it is relevant; otherwise light counts as unpolarised at every event.
  bool polarisation = true;
  PathSampling sampling = {};  ///< See `IntegratorTraits::sampling_options`.
};

/// Output files that the scene file requests, and the appearance of the picture.
struct OutputSettings {
  std::filesystem::path image;    ///< File of film values; empty if none is requested.
  std::filesystem::path display;  ///< Picture file for displays; empty if none is requested.
  /// Film value displayed as diffuse white, in the film's unit. Absent: chosen from the image.
  std::optional<double> display_exposure;
  std::optional<White> white = {};  ///< Absent: chosen from the lights.
};

/// The shapes as Embree geometry; see `scene/geometry.h`.
class Geometry;

/// The intersection of a ray with the scene, in the float coordinates of the render.
struct SurfaceHit {
  Imath::V3f point;     ///< [m], rounded towards the ray's origin.
  Imath::V3f normal;    ///< Geometric normal: unit, outward from the shape, whatever the ray's direction.
  float t;              ///< Distance along the ray [m].
  std::uint32_t shape;  ///< Index into `Scene::shapes`.
  std::uint32_t primitive = 0;  ///< Index of the triangle in its mesh or quad; 0 for curved shapes.
  /// Surfaces within this distance [m] on both sides coincide with this one, and new rays start outside it.
  /// `Scene::intersect` sets 0; the integrators set it where they handle coincident surfaces.
  float coincidence_radius = 0;
  float retreat_m = 0;  ///< Distance [m] by which a ray that leaves to its incident side starts farther back.
};

/// A ray that leaves the surface in the unit `direction` at that time of the exposure. It starts outside all
/// coincident surfaces, on the side to which `direction` points, and is infinite.
[[nodiscard]] inline Ray spawn(const SurfaceHit& hit, const Imath::V3f& direction, float time) {
  const float clear = std::copysign(hit.coincidence_radius, hit.normal.dot(direction));
  return spawn(hit.point + hit.normal * clear, hit.normal, direction, time);
}

/// The overload for a path that arrived along the unit propagation direction `from`, towards the surface. A
/// ray that leaves to the side of arrival also starts `retreat_m` farther back. Where surfaces meet, rounding
/// may have exchanged the farther hit and the nearer one, which would put the ray behind the nearer one.
[[nodiscard]] inline Ray spawn(const SurfaceHit& hit, const Imath::V3f& from, const Imath::V3f& direction,
                               float time) {
  Ray ray = spawn(hit, direction, time);
  if (!(hit.normal.dot(from) * hit.normal.dot(direction) > 0)) return ray;
  ray.origin = rounded_back(Imath::V3d(ray.origin) + Imath::V3d(from) * static_cast<double>(hit.retreat_m),
                            -Imath::V3d(from));
  return ray;
}

/// The hits of a ray with coincident surfaces; the first is the one that the ray query found.
struct CoincidentHits {
  static constexpr std::size_t kMaxHits = 16;  ///< Further coincident surfaces are ignored.
  /// Minimum absolute cosine between the normals of coincident surfaces.
  static constexpr double kParallel = 0.999;
  std::array<SurfaceHit, kMaxHits> at;  ///< The first `count` elements are valid.
  std::size_t count = 0;

  [[nodiscard]] std::span<const SurfaceHit> all() const& { return {at.data(), count}; }
  void all() const&& = delete;  // the span would dangle
};

/// All input of a render. Lengths are in metres. Render coordinates are recentred to be small: the scene
/// file's position `origin_m` becomes (0, 0, 0). Ray queries and `features` require `commit`. After that,
/// threads may call const functions concurrently.
class Scene {
 public:
  std::vector<ShapeInstance> shapes;
  std::vector<Material> materials;
  std::vector<ChartInstance> charts;
  std::vector<Light> lights;
  Camera camera;
  std::vector<Channel> channels;
  /// The channel of each pixel. Without a mosaic every pixel has all channels.
  std::optional<Mosaic> mosaic;
  double exposure_s = 1;  ///< Exposure time of a row [s].
  Shutter shutter;        ///< `commit` simplifies it if nothing moves.
  /// Fraction of a pixel's area that is sensitive. The signal of a pixel is its film value times the squared
  /// pixel pitch times this.
  double fill_factor = 1;
  /// Conversion of the film to digital numbers, if the scene has a readout.
  std::optional<Readout> readout;
  /// The bins whose channels `channels` are, if the film records spectral radiance.
  std::optional<SpectralBins> spectral;
  /// Band edges [nm], increasing, of the spectral image that the sensor views; empty if it views none.
  std::vector<double> image_band_edges_nm;
  std::string sensor_text;  ///< The sensor's description, as one line of JSON; empty without a sensor.
  RenderSettings render;
  OutputSettings output;
  SceneFeatures features;        ///< Set by `commit`.
  Imath::V3d origin_m{0, 0, 0};  ///< Scene-file position [m] of the origin of render coordinates.
  double unit_m = 1;             ///< Metres per scene-file unit.
  /// Box of all shapes except distant ones, and of a probe with an area. Set by `commit`; empty if there are
  /// none.
  Imath::Box3d bounds;
  /// Shapes entirely farther than this from the camera [m] are distant; see `WorkingRange`. Set by `commit`.
  double far_threshold_m = 0;
  std::string sha256;  ///< Hash of the scene file after overrides and of all files that it names.

  /// Names of `channels`, in their order.
  [[nodiscard]] std::vector<std::string> channel_names() const;
  /// Names of the film's planes: the channels, or the single plane of a mosaic.
  [[nodiscard]] std::vector<std::string> film_planes() const;

  /// Nearest hit at t in (0, ray.t_max), boundaries of media included; nothing if the ray misses. Rays start
  /// where `spawn` puts them, so that no epsilon is needed.
  [[nodiscard]] std::optional<SurfaceHit> intersect(const Ray& ray) const;
  /// The surfaces that coincide at the ray's time with `hit`, the hit of `ray`, which is the first of them.
  /// They are parallel and within `coincidence_tolerance`, in order along the ray. Each side of a shape
  /// counts once.
  [[nodiscard]] CoincidentHits coincident(const Ray& ray, const SurfaceHit& hit) const;
  /// True if a ray that is transmitted at `hit` in the unit `direction` may start behind an opaque surface.
  /// Floats do not separate the surface from a wall that crosses it or ends at it. Surfaces within
  /// `hit.coincidence_radius` do not count. `time` is that of the ray.
  [[nodiscard]] bool transmission_may_leak(const SurfaceHit& hit, const Imath::V3f& direction,
                                           float time) const {
    return shapes[hit.shape].near_wall_bounds.intersects(hit.point) &&
           wall_within_rounding(hit, direction, time);
  }
  /// Distance [m] below which surfaces of the two shapes, given by index, coincide near `point`. Floats of
  /// the size of the point and of the vertices do not separate them.
  [[nodiscard]] double coincidence_tolerance(const Imath::V3d& point, std::uint32_t shape,
                                             std::uint32_t other) const;
  /// The maximum of this distance over all other shapes.
  [[nodiscard]] double coincidence_tolerance(const Imath::V3d& point, std::uint32_t shape) const;
  /// The maximum of this distance everywhere except at distant shapes.
  [[nodiscard]] double coincidence_tolerance() const;
  /// True if any surface except boundaries of media, transparent ones included, lies between two points that
  /// `offset_point` moved off their surfaces. Exact at both ends, at every angle and distance. Moving shapes
  /// are at time 0.
  [[nodiscard]] bool occluded(const Imath::V3f& from, const Imath::V3f& to) const;
  /// The overload for a ray at t in (0, ray.t_max) and at its time.
  [[nodiscard]] bool occluded(const Ray& ray) const;

  /// Finds the nearest hit of each ray as if it were traced alone. `hits` has as many elements as `rays`.
  void intersect(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits) const;
  /// Sets `blocked` to 1 for each shadow ray that is occluded, otherwise to 0. It has as many elements as
  /// `rays`.
  void occluded(std::span<const BasicRay<double>> rays, std::span<std::uint8_t> blocked) const;

  /// Traces all the rays again through Embree alone and discards the results, to measure the cost of ray
  /// tracing by itself.
  void replay(std::span<const LoggedRay> rays) const;

  /// Indices into `lights` of those that a ray which leaves the scene may hit: environment lights and suns.
  [[nodiscard]] std::span<const std::uint32_t> background() const { return background_; }

  /// True if the light is a distant shape, or a point or spot light farther than `far_threshold_m`, so that
  /// its rays are practically parallel. False for lights at infinity.
  [[nodiscard]] bool is_distant(const Light& light) const;

  /// Prepares the scene; call once, after all lists are filled. Builds the acceleration structure, `bounds`,
  /// the working range, the volumes of media, the tables of rough dielectrics in media, the areas of lights,
  /// and `features`. Replaces `shutter` by its static equivalent if nothing moves. Throws Error{resource} if
  /// memory is exhausted and Error{internal} if Embree fails otherwise.
  void commit();

  /// Number of triangles as rendered, with those of every instance; a quad counts as two.
  [[nodiscard]] std::size_t triangle_count() const;
  /// Memory in bytes of the geometry, lights and textures, from Embree and the lists.
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  void measure_working_range();
  void measure_media();
  [[nodiscard]] bool wall_within_rounding(const SurfaceHit& hit, const Imath::V3f& direction,
                                          float time) const;

  std::shared_ptr<const Geometry> geometry_;
  std::vector<std::uint32_t> background_;
  double max_rounding_ = 0;  // largest rounding of the shapes that are not distant
};

/// A hit in double precision, and the index of its shape in `Scene::shapes`.
struct ExactHit {
  ShapeHit<double> hit;
  std::uint32_t shape;
};
/// Finds the nearest hit at t in (t_min, ray.t_max) by each shape's own formula, without Embree; nothing if
/// the ray misses. At equal distances the shape with the lowest index wins. Its cost is linear in the number
/// of shapes.
[[nodiscard]] std::optional<ExactHit> intersect_exact(const Scene& scene, const BasicRay<double>& ray,
                                                      double t_min);

/// The material of the shape with that index in `Scene::shapes`.
[[nodiscard]] inline const Material& material_of(const Scene& scene, std::uint32_t shape) {
  return scene.materials[scene.shapes[shape].material];
}

/// Shading frame of a hit, in render coordinates, and its texture coordinates. The frame's z axis is the
/// outward normal, as modified by vertex normals and by a relief: a normal or bump map.
struct ShadingPoint {
  Basis<float> frame;
  Imath::V2f uv{0, 0};  ///< As `SurfaceCoordinates::uv`.
  bool relief = false;  ///< True if z may differ from the geometric normal.
};

/// Shading point of a hit at that time, a fraction of the exposure, for scenes with `features.textures`;
/// elsewhere the geometric normal suffices. Vertex normals apply first, then a relief. If the material needs
/// texture coordinates, they are computed and the x axis runs along dp/du, made perpendicular to z. Otherwise
/// they are (0, 0) and the x axis is arbitrary.
[[nodiscard]] ShadingPoint textured_shading_point(const Scene& scene, const SurfaceHit& hit, float time);

}  // namespace abbe
