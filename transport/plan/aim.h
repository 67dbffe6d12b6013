#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <ImathVec.h>

#include "scene/lights/light.h"

namespace abbe {

/// Where a light sends its photons: a direction and its density [1/sr].
struct AimedDirection {
  Imath::V3f wi;
  float pdf;
};

/// Where photons of a light that is far are sent through: a point of the target facing it, with its density
/// [1/m^2] there.
struct AimedPoint {
  Imath::V3f point;
  float pdf;
};

/// The ray of a photon that shows where to aim others, and how much it counts.
struct ShownRay {
  Imath::V3f from;
  Imath::V3f direction;
  double worth;
  std::uint32_t branch = 0;  ///< Rays of one branch meet the same specular shapes by the same events.
};

/// Aims photons of one light at the sphere that bounds the specular shapes: directions are drawn through a
/// square target facing the light, except for a share drawn from the light's own emission. The share keeps
/// every direction possible, so aiming changes the noise and not the image. A light within the target, or
/// close to it, has all directions around it for a target instead, and shines as it does until it has learnt.
class Aim {
 public:
  /// Emission alone, where there is no target.
  Aim() = default;
  /// Aims at the bounding sphere of the targets, seen from a light of that radius; at all parts of it alike.
  /// Of a light close to it nothing is aimed yet. A `beam` is the unit direction of one that shines within a
  /// narrow cone.
  Aim(const Imath::V3f& light_center, float light_radius, const Imath::V3f& target_center,
      float target_radius, const std::optional<Imath::V3f>& beam = std::nullopt);
  /// Makes the aim of a light so far that its rays all run within an angle of cosine `least_cosine` to the
  /// unit direction `axis`: `point` covers the whole sphere for each of them, evenly until `guide` lets it
  /// learn.
  [[nodiscard]] static Aim from_afar(const Imath::V3f& axis, double least_cosine,
                                     const Imath::V3f& target_center, double target_radius);
  void guide() { guided_ = true; }

  /// Aims where others have gone, but for a tenth that goes anywhere, or half of them after `guess`. The
  /// target is put at the distance where they come through the smallest part of it: seen from all of a lamp,
  /// what lets its light through fills the same part only of a target that stands where it does, as a slit
  /// before a prism. A grid of densities covers that part, smoothed over as many of its cells as few rays
  /// need.
  ///
  /// Each branch of rays has a grid of its own, over the part that this branch comes through; of more than
  /// `most_branches` the weakest have one in common. Let f be the fraction of photons that follow others, and
  /// w_i the weight of branch i of n. A quarter of f is spread evenly, so that no later pilot loses a branch:
  ///     f_i = f [3/4 w_i / (sum_j w_j) + 1/(4 n)].
  /// Eight rays show the extent of a branch within the margin of a grid. Around fewer rays of one branch
  /// among several, photons are aimed at all scales alike.
  void learn(std::span<const ShownRay> shown, std::size_t most_branches = 6);
  /// Effective number of photons, (sum w)^2 / sum w^2, that train a light or a branch.
  static constexpr double kEnough = 50;
  /// Aims half of the photons around where few others have gone, which do not tell how far around: at all
  /// scales alike. The other half goes anywhere, from then on. Changes nothing once others were enough to
  /// learn from.
  void guess(std::span<const ShownRay> shown);
  /// Whether these change anything: whether there is a target.
  [[nodiscard]] bool learns() const { return guided_ || around_; }

  /// Whether some directions are not drawn from the light's emission.
  [[nodiscard]] bool guided() const { return guided_; }

  /// Through a target before the light.
  [[nodiscard]] AimedPoint point(Imath::V2f u) const;
  [[nodiscard]] const Imath::V3f& axis() const { return axis_; }
  [[nodiscard]] float half_size() const { return half_size_; }

  /// Draws a direction for a photon leaving `from` at that time; `u` aims, `choice` picks between target and
  /// emission. A direction in which the light does not emit has no power, not no density.
  [[nodiscard]] AimedDirection sample(const Light& light, const EmissionPoint& from, float choice,
                                      Imath::V2f u, float time) const;

 private:
  // A place on the unit square that the target is, with its density there.
  struct Place {
    Imath::V2f at;
    float pdf;
  };
  struct WeighedPlace {
    Imath::V2f at;
    double worth;
    std::uint32_t branch = 0;
  };
  using Branch = std::vector<WeighedPlace>;
  // A part of the unit square.
  struct Window {
    Imath::V2f corner{0, 0};
    Imath::V2f size{1, 1};
    [[nodiscard]] float area() const { return size.x * size.y; }
    [[nodiscard]] bool holds(const Imath::V2f& at) const;
  };
  // Densities over the cells of a window.
  struct Grid {
    Grid(const Window& over, const std::vector<WeighedPlace>& places);
    [[nodiscard]] Place draw(Imath::V2f u) const;
    [[nodiscard]] float pdf(const Imath::V2f& at) const;

    Window window;
    float share = 0;                // of what is drawn
    std::vector<float> density;     // per cell, over the unit square
    std::vector<float> row_cdf;     // kCells
    std::vector<float> column_cdf;  // kCells per row
  };

  void face(const Imath::V3f& axis, const Imath::V3f& target_center, float half_size);
  void stand(float nearer);
  [[nodiscard]] float extent_of(const Window& window, float nearer) const;
  void stand_where_fewest_pass(std::span<const ShownRay> shown);
  [[nodiscard]] std::optional<Imath::V2f> place_of(const Imath::V3f& from, const Imath::V3f& direction) const;
  [[nodiscard]] std::vector<WeighedPlace> places_of(std::span<const ShownRay> shown) const;
  [[nodiscard]] static std::vector<WeighedPlace> spread_over_scales(const std::vector<WeighedPlace>& places);
  [[nodiscard]] static std::vector<Branch> branches_of(const std::vector<WeighedPlace>& places,
                                                       std::size_t most);
  [[nodiscard]] static double weight_of(const Branch& branch);
  [[nodiscard]] static double photons_of(const Branch& branch);
  [[nodiscard]] Branch add_grid_of(Branch branch, bool guesses);
  [[nodiscard]] static Window window_of(const std::vector<WeighedPlace>& places);
  [[nodiscard]] Place draw(Imath::V2f u) const;
  [[nodiscard]] float pdf_at(const Imath::V2f& at) const;
  [[nodiscard]] Imath::V3f point_at(const Imath::V2f& at) const;
  [[nodiscard]] Imath::V3f direction_to(const Imath::V3f& from, const Imath::V2f& at) const;
  [[nodiscard]] float pdf_of_direction(const Imath::V3f& from, const Imath::V3f& direction, float pdf) const;

  bool guided_ = false;
  bool around_ = false;  // places are of directions: equal ones of azimuth and of the cosine to the axis
  bool far_ = false;
  Imath::V3f target_center_{0, 0, 0};
  Imath::V3f axis_{0, 0, 1};  // from the light to the target
  Imath::V3f side_{1, 0, 0};
  Imath::V3f top_{0, 1, 0};
  float distance_ = 0;          // from the middle of the light to the target,
  float target_half_size_ = 0;  // whose half size is this at its middle,
  float nearest_ = 0;           // and how much nearer to the light it may stand at most,
  float growth_ = 0;            // by how much its half size grows for each such metre,
  Imath::V3f center_{0, 0, 0};  // and where it stands
  float half_size_ = 0;
  std::vector<Grid> grids_;   // once it has learnt or guessed,
  bool has_learned_ = false;  // which of them,
  float anywhere_ = 0.1F;     // and the share that then goes anywhere
};

}  // namespace abbe
