#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <ImathVec.h>

#include "scene/lights/light.h"

namespace abbe {

/// Direction of a photon at its light, with its pdf [1/sr].
struct GuidedDirection {
  Imath::V3f wi;  ///< Unit direction in which the photon leaves, in world space.
  float pdf;
};

/// Point of the target through which a photon of a distant light is sent, with its pdf [1/m^2] on the target.
struct GuidedPoint {
  Imath::V3f point;  ///< Point in world space.
  float pdf;
};

/// A sphere around a specular shape, in world space [m].
struct BoundingSphere {
  Imath::V3f center;
  float radius;
};

/// Ray of a pilot photon that trains a guide, with its weight.
struct PilotRay {
  Imath::V3f from;           ///< Origin in world space.
  Imath::V3f direction;      ///< Unit direction away from the light.
  double weight;             ///< Positive weight of the ray in training, in any unit.
  std::uint32_t branch = 0;  ///< Rays of one branch hit the same specular shapes with the same events.
};

/// Distribution of the photons of one light over directions, towards the sphere that bounds the specular
/// shapes. Directions are sampled through a square target that faces the light, except for a defensive
/// fraction sampled from the light's own emission. Every direction thus has a positive pdf, so guiding
/// changes the noise but not the expected image. A light within the target or close to it uses all directions
/// as its target, and emits unguided until it is trained.
class PhotonGuide {
 public:
  /// Unguided emission, for a light without a target.
  PhotonGuide() = default;
  /// Guides to the bounding sphere of the targets, uniformly, for a light with the given center and radius
  /// [m]. A light close to the sphere is not guided before training. `beam` is the unit axis of a light with
  /// a narrow cone. The guide has no target if `target_radius` is 0.
  PhotonGuide(const Imath::V3f& light_center, float light_radius, const Imath::V3f& target_center,
              float target_radius, const std::optional<Imath::V3f>& beam = std::nullopt);
  /// Guide for a distant light whose rays all lie within an angle of cosine `min_cosine` around the unit
  /// direction `axis`. `point` covers the whole sphere for each of these rays, uniformly until the guide is
  /// enabled and trained.
  [[nodiscard]] static PhotonGuide for_distant_light(const Imath::V3f& axis, double min_cosine,
                                                     const Imath::V3f& target_center, double target_radius);
  /// Lets a guide of a distant light be trained.
  void enable_guiding() { guided_ = true; }
  /// Divides half of the photons that are sent before training equally among the `casters`, so that a small
  /// caster is found as soon as a large one. The other half stays uniform. Does nothing for fewer than two
  /// casters, for many, and for a light whose photons are not guided before training.
  void stratify(std::span<const BoundingSphere> casters);

  /// Trains the distribution with pilot rays. A tenth of the photons stays uniform, or a half after
  /// `train_from_few`. The target moves to the distance at which the rays pass through its smallest part.
  /// Whatever transmits the light, such as a slit before a prism, fills the same part for all points of the
  /// light only at its own distance. A grid of densities covers that part; its smoothing grows as the number
  /// of rays falls.
  ///
  /// Each branch of rays has its own grid over its own part. If there are more than `max_branches`, the
  /// weakest have one grid in common. Let f be the fraction of guided photons and w_i the weight of branch i
  /// of n. A quarter of f is divided equally among the branches, so that no later pilot loses one:
  ///     f_i = f [3/4 w_i / (sum_j w_j) + 1/(4 n)].
  /// Eight rays determine the extent of a branch to within the margin of a grid. If one of several branches
  /// has fewer rays, photons are sent around them at all scales. `max_branches` is at least 1. Does nothing
  /// without rays that hit the target, or if `can_train` is false.
  void train(std::span<const PilotRay> pilot_rays, std::size_t max_branches = 6);
  /// Effective number of photons, (sum w)^2 / sum w^2, that train a light or a branch.
  static constexpr double kEnoughPhotons = 50;
  /// Guides half of the photons around a few pilot rays, at all scales, because few rays do not determine the
  /// extent; their weights are ignored. The other half is uniform from then on. Does nothing after `train`,
  /// without rays that hit the target, or if `can_train` is false.
  void train_from_few(std::span<const PilotRay> pilot_rays);
  /// True if training has an effect. This needs a target; a guide `for_distant_light` also needs
  /// `enable_guiding`.
  [[nodiscard]] bool can_train() const { return guided_ || all_directions_; }

  /// True if photons are sent through the target, until training uniformly or as `stratify` divides them. A
  /// distant guide is guided from `enable_guiding` on. A light within its target or close to it is guided
  /// only after training.
  [[nodiscard]] bool is_guided() const { return guided_; }

  /// Samples a point of the target in front of a distant light with `u` in [0, 1)^2. The guide must be one
  /// `for_distant_light`.
  [[nodiscard]] GuidedPoint point(Imath::V2f u) const;
  /// Unit axis from the light to the target, perpendicular to the target.
  [[nodiscard]] const Imath::V3f& axis() const { return axis_; }
  /// Half the edge of the square target [m].
  [[nodiscard]] float half_size() const { return half_size_; }

  /// Samples the direction of a photon that leaves `from` at a time (fraction of the exposure), for lights
  /// that are neither distant nor at infinity. `choice` in [0, 1) selects target or emission, `u` in [0, 1)^2
  /// the direction. A direction without emission has zero power, but a positive pdf.
  [[nodiscard]] GuidedDirection sample(const Light& light, const EmissionPoint& from, float choice,
                                       Imath::V2f u, float time) const;

 private:
  // Point of the unit square that parametrises the target, with its pdf.
  struct SquarePoint {
    Imath::V2f at;
    float pdf;
  };
  struct WeightedPoint {
    Imath::V2f at;
    double weight;
    std::uint32_t branch = 0;
  };
  using Branch = std::vector<WeightedPoint>;
  // Part of the unit square.
  struct Window {
    Imath::V2f corner{0, 0};
    Imath::V2f size{1, 1};
    [[nodiscard]] float area() const { return size.x * size.y; }
    [[nodiscard]] bool holds(const Imath::V2f& at) const;
  };
  // Piecewise constant density over the cells of a window.
  struct Grid {
    // A constant density, with empty arrays.
    Grid(const Window& over, float of_samples) : window(over), fraction(of_samples) {}
    Grid(const Window& over, const std::vector<WeightedPoint>& points);
    [[nodiscard]] SquarePoint draw(Imath::V2f u) const;
    [[nodiscard]] float pdf(const Imath::V2f& at) const;

    Window window;
    float fraction = 0;             // of all samples
    std::vector<float> density;     // per cell, relative to the unit square
    std::vector<float> row_cdf;     // size kCells
    std::vector<float> column_cdf;  // size kCells per row
  };

  void face(const Imath::V3f& axis, const Imath::V3f& target_center, float half_size);
  void set_target_distance(float offset);
  [[nodiscard]] Window window_of(const BoundingSphere& caster) const;
  [[nodiscard]] float footprint_of(const Window& window, float offset) const;
  void minimise_footprint(std::span<const PilotRay> pilot_rays);
  [[nodiscard]] std::optional<Imath::V2f> to_square(const Imath::V3f& from,
                                                    const Imath::V3f& direction) const;
  [[nodiscard]] std::vector<WeightedPoint> to_square(std::span<const PilotRay> pilot_rays) const;
  [[nodiscard]] static std::vector<WeightedPoint> spread_over_scales(
      const std::vector<WeightedPoint>& points);
  [[nodiscard]] static std::vector<Branch> branches_of(const std::vector<WeightedPoint>& points,
                                                       std::size_t max_branches);
  [[nodiscard]] static double weight_of(const Branch& branch);
  [[nodiscard]] static double photons_of(const Branch& branch);
  [[nodiscard]] Branch add_grid_of(Branch branch, bool from_few);
  [[nodiscard]] static Window window_of(const std::vector<WeightedPoint>& points);
  [[nodiscard]] SquarePoint draw(Imath::V2f u) const;
  [[nodiscard]] float pdf_at(const Imath::V2f& at) const;
  [[nodiscard]] Imath::V3f point_at(const Imath::V2f& at) const;
  [[nodiscard]] Imath::V3f direction_to(const Imath::V3f& from, const Imath::V2f& at) const;
  [[nodiscard]] float pdf_of_direction(const Imath::V3f& from, const Imath::V3f& direction, float pdf) const;

  bool guided_ = false;
  bool all_directions_ = false;  // square is (azimuth, cosine with the axis)
  bool distant_ = false;
  Imath::V3f target_center_{0, 0, 0};
  Imath::V3f axis_{0, 0, 1};  // from the light to the target
  Imath::V3f side_{1, 0, 0};
  Imath::V3f top_{0, 1, 0};
  float distance_ = 0;          // From the light's center to the target's center [m].
  float target_half_size_ = 0;  // Half size at the target's center [m].
  float max_offset_ = 0;        // Maximum offset towards the light [m].
  float growth_ = 0;            // Growth of the half size per metre of offset.
  Imath::V3f center_{0, 0, 0};  // Current center of the target.
  float half_size_ = 0;
  std::vector<Grid> grids_;  // empty before `stratify` and training
  bool trained_ = false;     // true after `train`
  bool stratified_ = false;  // true from `stratify` until training
  static constexpr float kUniformFraction = 0.1F;
  float uniform_fraction_ = kUniformFraction;  // of the guided photons
};

}  // namespace abbe
