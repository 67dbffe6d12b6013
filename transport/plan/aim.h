#pragma once

#include <vector>

#include <ImathVec.h>

#include "scene/lights/light.h"

namespace abbe {

/// Where a light sends its photons: a direction and its density [1/sr].
struct AimedDirection {
  Imath::V3f wi;
  float pdf;
  int cell = -1;  ///< Cell that it was aimed at, or that it goes to around the light; or -1.
};

/// Where photons of a light that is far are sent through: a point of the target facing it, with its density
/// [1/m^2] there.
struct AimedPoint {
  Imath::V3f point;
  float pdf;
  int cell;  ///< Of the target, or -1 where there is nothing to learn.
};

/// Aims photons of one light at the sphere that bounds the specular shapes: directions are drawn through a
/// disc-shaped target facing the light, by a grid of importances over it, except for a share drawn from the
/// light's own emission. The share keeps every direction possible, so aiming changes the noise and not the
/// image. A light within the target, or close to it, has the grid over all directions around it instead, and
/// shines as it does until it has learnt.
class Aim {
 public:
  static constexpr int kCells = 256;  ///< Along each side of the square around the target.
  static constexpr int kGrid = kCells * kCells;

  /// Emission alone, where there is no target.
  Aim() = default;
  /// Aims at the bounding sphere of the targets, seen from `light_center`; all parts of it alike. Of a light
  /// close to it nothing is aimed yet.
  Aim(const Imath::V3f& light_center, const Imath::V3f& target_center, float target_radius);
  /// Makes the aim of a light so far that its rays all run within an angle of cosine `least_cosine` to the
  /// unit direction `axis`: `point` covers the whole sphere for each of them, evenly until `guide` lets it
  /// learn.
  [[nodiscard]] static Aim from_afar(const Imath::V3f& axis, double least_cosine,
                                     const Imath::V3f& target_center, double target_radius);
  void guide();

  /// Replaces the importances, one per cell, by measured ones, spread over the cells within `reach` of each
  /// and mixed with a tenth of the uniform ones.
  void learn(const std::vector<double>& importance, int reach);

  /// Whether some directions are not drawn from the light's emission.
  [[nodiscard]] bool guided() const { return guided_; }
  /// Nothing yet for each cell, for what is measured to be added to; no cells of an aim that cannot learn.
  [[nodiscard]] std::vector<double> no_importance() const {
    return std::vector<double>(guided_ || around_ ? kGrid : 0, 0.0);
  }

  /// Through a target before the light.
  [[nodiscard]] AimedPoint point(Imath::V2f u) const;
  [[nodiscard]] const Imath::V3f& axis() const { return axis_; }
  [[nodiscard]] float half_size() const { return half_size_; }

  /// Draws a direction for a photon leaving `from` at that time; `u` aims, `choice` picks between target and
  /// emission. A direction in which the light does not emit has no power, not no density.
  [[nodiscard]] AimedDirection sample(const Light& light, const EmissionPoint& from, float choice,
                                      Imath::V2f u, float time) const;

 private:
  // A place on the unit square of the cells.
  struct GridPoint {
    float a;
    float b;
    int cell;
  };

  void face(const Imath::V3f& axis, const Imath::V3f& target_center, float half_size);
  [[nodiscard]] GridPoint grid_point(Imath::V2f u) const;
  [[nodiscard]] int cell_met(const Imath::V3f& from, const Imath::V3f& direction) const;  // or -1
  [[nodiscard]] float target_pdf(const Imath::V3f& from, const Imath::V3f& direction, int cell) const;
  [[nodiscard]] int cell_of(float a, float b) const;
  void build(const std::vector<double>& weights);

  bool guided_ = false;
  bool around_ = false;  // cells are of directions: equal ones of azimuth and of the cosine to the axis
  Imath::V3f center_{0, 0, 0};
  Imath::V3f axis_{0, 0, 1};  // from the light to the target
  Imath::V3f side_{1, 0, 0};
  Imath::V3f top_{0, 1, 0};
  float half_size_ = 0;
  std::vector<float> density_;     // per cell, over the unit square
  std::vector<float> row_cdf_;     // kCells
  std::vector<float> column_cdf_;  // kCells per row
};

}  // namespace abbe
