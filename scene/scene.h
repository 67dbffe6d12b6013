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
#include "scene/needs.h"
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

/// A colour chart of the scene: its patches are the quads `shapes[first]` and those that follow.
struct ChartInstance {
  std::string name;
  std::uint32_t first;
  std::uint32_t patches;
};

/// Which techniques render the scene.
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
/// Their words in scenes, commands and films, in that order.
inline constexpr std::array kIntegratorNames{"auto", "path", "light", "bdpt",         "photon-map",
                                             "ppm",  "sppm", "vcm",   "photon-brute", "adjoint-brute"};
/// The word of one.
[[nodiscard]] constexpr const char* integrator_name(Integrator integrator) {
  return kIntegratorNames.at(static_cast<std::size_t>(integrator));
}

/// How techniques gather photons.
struct PhotonSettings {
  std::optional<std::uint64_t> per_sample = {};  ///< Photons of a sample; as many as pixels when absent.
  std::optional<double> radius_m = {};           ///< Of the first gathering; by the scene's size when absent.
  int nearest = 50;                              ///< That a photon map's estimate is made of.
  bool final_gather = false;                     ///< Whether a photon map is looked at one event later.
};

/// By what Integrator::path draws directions after an event at a surface, a meter's among them, that is not
/// of a single direction: by the surface's own scattering; with the density cos/pi; or evenly. Both of the
/// latter are over the side that the path came from, or over both sides, at half the density, where light may
/// come through.
enum class DirectionSampling { bsdf, cosine, uniform };

/// By which of both ways Integrator::path finds light after such an event, or one within matter: by all, each
/// weighed; by following scattering alone; or by connecting alone wherever a connection may be drawn.
enum class LightStrategy { mis, bsdf, light };

/// How both ways are weighed [Veach1997, sec. 9.2]: by their densities, or by the squares of these.
enum class MisHeuristic { balance, power };

/// How Integrator::path draws its paths. It changes the noise, and nothing of what is found but what
/// `unreached` tells.
struct PathSampling {
  DirectionSampling directions = DirectionSampling::bsdf;
  LightStrategy lights = LightStrategy::mis;
  MisHeuristic heuristic = MisHeuristic::balance;

  friend bool operator==(const PathSampling&, const PathSampling&) = default;
};

/// How to render, as the scene file asks.
struct RenderSettings {
  Integrator integrator = Integrator::automatic;
  int samples = 64;  ///< Per pixel.
  /// Events a path may have between its ends, at surfaces and within matter: 1 is light that is scattered
  /// once. Absent, chance alone ends paths.
  std::optional<int> max_depth = {};
  int roulette_depth = 4;  ///< Events before Russian roulette; a negative value never plays it.
  std::uint64_t seed = 0;
  PhotonSettings photons = {};
  bool consistent = false;  ///< Whether Integrator::automatic may also choose what blurs, ever less.
  /// Whether paths carry it where it matters; else all light counts as unpolarised at every event.
  bool polarisation = true;
  PathSampling sampling = {};  ///< Of Integrator::path; by default of every other.
};

/// Where to write, as the scene file asks; empty when it does not.
struct OutputSettings {
  std::filesystem::path image;
  std::filesystem::path display;
  std::optional<double>
      display_exposure;             ///< Film value shown as diffuse white; chosen from the image when absent.
  std::optional<White> white = {};  ///< Chosen among the lights when absent.
};

/// Embree's view of the shapes.
class Geometry;

/// Where a ray meets the scene, in the float coordinates of the render.
struct SurfaceHit {
  Imath::V3f point;
  Imath::V3f normal;  ///< Geometric, unit, outward.
  float t;
  std::uint32_t shape;
  std::uint32_t primitive = 0;  ///< Which triangle of a mesh, in its own order.
  float spread = 0;             ///< How far to both sides [m] are surfaces that count as one with this.
  float back = 0;  ///< How far back on its way [m] a ray that leaves to the side it came from starts.
};

/// A ray that leaves the surface into `direction`, clear of those that count as one with it.
[[nodiscard]] inline Ray spawn(const SurfaceHit& hit, const Imath::V3f& direction, float time) {
  const float clear = std::copysign(hit.spread, hit.normal.dot(direction));
  return spawn(hit.point + hit.normal * clear, hit.normal, direction, time);
}

/// The same of a ray that came there from the unit direction `from`. One that leaves to the side it came from
/// starts `back` on its way as well: where surfaces meet, rounding may have taken the further one for the
/// nearer, and the ray beyond that.
[[nodiscard]] inline Ray spawn(const SurfaceHit& hit, const Imath::V3f& from, const Imath::V3f& direction,
                               float time) {
  Ray ray = spawn(hit, direction, time);
  if (!(hit.normal.dot(from) * hit.normal.dot(direction) > 0)) return ray;
  ray.origin = rounded_back(Imath::V3d(ray.origin) + Imath::V3d(from) * static_cast<double>(hit.back),
                            -Imath::V3d(from));
  return ray;
}

/// Surfaces met together.
struct TouchingSurfaces {
  static constexpr std::size_t kMost = 16;
  static constexpr double kParallel = 0.999;  ///< Least cosine between their normals.
  std::array<SurfaceHit, kMost> at;
  std::size_t count = 0;

  [[nodiscard]] std::span<const SurfaceHit> all() const& { return {at.data(), count}; }
  void all() const&& = delete;  // what it looks at would be gone
};

/// Everything a render needs, in metres, recentred so that coordinates are small: `origin_m` is the
/// scene-file point at (0,0,0).
class Scene {
 public:
  std::vector<ShapeInstance> shapes;
  std::vector<Material> materials;
  std::vector<ChartInstance> charts;
  std::vector<Light> lights;
  Camera camera;
  std::vector<Channel> channels;
  std::optional<Mosaic> mosaic;  ///< Which channel each pixel has; without one every pixel has them all.
  double exposure_s = 1;
  Shutter shutter;         ///< Which `commit` makes plain where nothing moves.
  double fill_factor = 1;  ///< Share of a pixel that takes light: a pixel counts its film value times
                           ///< pixel pitch^2 times this.
  /// What makes digital numbers of the film, if the scene says.
  std::optional<Readout> readout;
  /// Whose channels are the channels, if the film is of radiance.
  std::optional<SpectralBins> spectral;
  /// Ends of the bands of the spectral image that the sensor looks at, if it looks at one [nm].
  std::vector<double> image_band_edges_nm;
  std::string sensor_text;  ///< The sensor's description, as one line of JSON.
  RenderSettings render;
  OutputSettings output;
  Needs needs;
  Imath::V3d origin_m{0, 0, 0};
  double unit_m = 1;      ///< Metres per scene-file unit.
  Imath::Box3d bounds;    ///< Of the shapes, but for those that are far, and of a meter that is no point.
  double far_from_m = 0;  ///< What lies wholly beyond this distance from the camera is far; see Extent.
  std::string sha256;     ///< Of the scene file after overrides, and of every file it names.

  [[nodiscard]] std::vector<std::string> channel_names() const;
  /// Names of the film's planes: the channels, or the one plane of a mosaic.
  [[nodiscard]] std::vector<std::string> film_planes() const;

  /// Nearest hit at t in (0, ray.t_max). Rays start where `spawn` put them, so no epsilon is needed.
  [[nodiscard]] std::optional<SurfaceHit> intersect(const Ray& ray) const;
  /// The surfaces that touch, at the ray's time, where `ray` meets the scene at `hit`, which is the first of
  /// them: parallel to it and within `touch_distance`. Of a shape, each side once.
  [[nodiscard]] TouchingSurfaces touching(const Ray& ray, const SurfaceHit& hit) const;
  /// Whether a ray of that direction that meets the scene at `hit` may start behind something opaque if it is
  /// let through there: floats do not tell the surface from a wall that crosses it or ends at it. Surfaces
  /// that `hit` spreads over are its own.
  [[nodiscard]] bool hides_beyond(const SurfaceHit& hit, const Imath::V3f& direction, float time) const {
    return shapes[hit.shape].at_walls.intersects(hit.point) && wall_within_rounding(hit, direction, time);
  }
  /// Around `point`, surfaces of the two shapes that are closer than this [m] count as one: floats of the
  /// size of the point, and of the vertices, hardly tell them apart.
  [[nodiscard]] double touch_distance(const Imath::V3d& point, std::uint32_t shape,
                                      std::uint32_t other) const;
  /// The most that is, for a shape and any other one.
  [[nodiscard]] double touch_distance(const Imath::V3d& point, std::uint32_t shape) const;
  /// The most it is anywhere but among what is far.
  [[nodiscard]] double touch_distance() const;
  /// Whether anything but boundaries of matter stands between two points that `offset_point` put beside their
  /// surfaces. Exact at both ends, at any angle and distance.
  [[nodiscard]] bool occluded(const Imath::V3f& from, const Imath::V3f& to) const;
  [[nodiscard]] bool occluded(const Ray& ray) const;

  /// Answers many rays at once, as many as answers, each as if it were alone: nearest hits, and whether (1 or
  /// 0) anything but boundaries of matter stands on each of the ways.
  void intersect(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits) const;
  void occluded(std::span<const BasicRay<double>> ways, std::span<std::uint8_t> blocked) const;

  /// Asks Embree alone for all of the rays again and drops the answers: what a render would cost if it did
  /// nothing else.
  void replay(std::span<const LoggedRay> rays) const;

  /// The lights that a ray which leaves the scene may see: the environment and the suns.
  [[nodiscard]] std::span<const std::uint32_t> background() const { return background_; }

  /// Whether the light has a place that is far, from where its rays are as good as parallel.
  [[nodiscard]] bool is_far(const Light& light) const;

  /// Builds the acceleration structure, `bounds`, what is far, the volumes of media, the tables of rough
  /// dielectrics in media, the lights' areas and `needs`; call once, after filling the lists. Throws
  /// Error{resource} when there is no memory.
  void commit();

  [[nodiscard]] std::size_t triangle_count() const;  ///< As rendered: a quad is two.
  [[nodiscard]] std::size_t memory_bytes() const;    ///< Of geometry, as Embree and the lists report it.

 private:
  void measure_extent();
  void measure_matter();
  [[nodiscard]] bool wall_within_rounding(const SurfaceHit& hit, const Imath::V3f& direction,
                                          float time) const;

  std::shared_ptr<const Geometry> geometry_;
  std::vector<std::uint32_t> background_;
  double coarsest_ = 0;  // rounding of those that are not far
};

/// Nearest hit at t in (t_min, ray.t_max) in double precision by each shape's own code, without Embree: for
/// `abbe trace`.
struct ExactHit {
  ShapeHit<double> hit;
  std::uint32_t shape;
};
[[nodiscard]] std::optional<ExactHit> intersect_exact(const Scene& scene, const BasicRay<double>& ray,
                                                      double t_min);

/// The material of a shape of the scene, by its number.
[[nodiscard]] inline const Material& material_of(const Scene& scene, std::uint32_t shape) {
  return scene.materials[scene.shapes[shape].material];
}

}  // namespace abbe
