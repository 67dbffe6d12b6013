#pragma once

#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <ImathVec.h>

#include "scene/lights/model.h"

namespace abbe {

/// Luminous intensity of a luminaire as a function of direction, by type C photometry: gamma is the angle
/// with the luminaire's axis, C the azimuth around it. The intensity is interpolated bilinearly in both
/// angles, and 0 outside the range of gamma. Directions are in the luminaire's frame: z along the axis, x in
/// the half-plane C = 0, y in C = 90 degrees.
class IntensityDistribution {
 public:
  /// Intensities [cd] on a grid of angles, as the constructor needs them.
  struct Table {
    std::vector<double> gammas_deg;  ///< At least 2, strictly ascending, in [0, 180].
    /// At least 2, strictly ascending: half-planes all around, of which the last repeats the first at 360
    /// degrees more.
    std::vector<double> planes_deg;
    std::vector<double> candelas;  ///< By half-plane, then by gamma; finite, 0 or more, not all 0.
  };
  /// The table is not checked.
  explicit IntensityDistribution(const Table& table);

  /// Luminous flux [lm]: the integral of the intensity over solid angle.
  [[nodiscard]] double luminous_flux() const { return flux_; }
  /// Intensity in a unit direction, relative to the mean over all directions.
  [[nodiscard]] float relative_intensity(const Imath::V3f& direction) const;
  /// Maximum of `relative_intensity`.
  [[nodiscard]] double max_relative_intensity() const { return max_; }
  /// The largest gamma [rad] at which light may be emitted.
  [[nodiscard]] double max_gamma() const { return gammas_.back(); }
  /// Samples a unit direction by `u` in [0, 1)^2: a cell of the grid in proportion to its flux, then
  /// uniformly by solid angle within the cell.
  [[nodiscard]] Imath::V3f sample(Imath::V2f u) const;
  /// Density [1/sr] of `sample`.
  [[nodiscard]] float pdf(const Imath::V3f& direction) const;
  /// Memory [bytes] of the distribution of a table with these numbers of angles.
  [[nodiscard]] static std::size_t memory_bytes(std::size_t gammas, std::size_t planes);
  [[nodiscard]] std::size_t memory_bytes() const { return memory_bytes(gammas_.size(), planes_.size()); }

 private:
  // A cell of the grid, between `gamma` and the next angle, and `plane` and the next half-plane; the
  // fractions are those of the direction between them.
  struct GridCell {
    std::size_t gamma, plane;
    double along_gamma, along_plane;
  };
  [[nodiscard]] std::optional<GridCell> cell_of(const Imath::V3f& direction) const;
  [[nodiscard]] double value(std::size_t plane, std::size_t gamma) const {
    return values_[plane * gammas_.size() + gamma];
  }
  [[nodiscard]] double cell_flux(std::size_t plane, std::size_t gamma) const;
  [[nodiscard]] double cell_solid_angle(std::size_t plane, std::size_t gamma) const;
  [[nodiscard]] std::size_t cell(std::size_t plane, std::size_t gamma) const {
    return plane * (gammas_.size() - 1) + gamma;
  }

  std::vector<double> gammas_;  // [rad]
  std::vector<double> planes_;  // [rad]
  std::vector<double> values_;  // relative to the mean over all directions; by half-plane, then by gamma
  std::vector<double> cdf_;     // of the cells, by half-plane, then by gamma
  double flux_ = 0;             // [lm]
  double max_ = 0;
};

/// A point with the intensity distribution of a luminaire. `Light::emission` is the mean spectral intensity
/// over all directions.
struct PhotometricLight {
  static constexpr bool kIsDelta = true;
  static constexpr bool kAtInfinity = false;

  Imath::V3f position{0, 0, 0};  ///< Render coordinates [m]; at time 0 if it moves.
  Imath::V3f axis{0, 0, -1};     ///< Unit direction of gamma = 0; at time 0 if it moves.
  Imath::V3f c0{1, 0, 0};  ///< Unit direction of C = 0, perpendicular to the axis; at time 0 if it moves.
  std::shared_ptr<const IntensityDistribution> distribution = nullptr;  ///< Must not be null.
  std::shared_ptr<const Motion> motion = nullptr;                       ///< Null if it does not move.

  // Functions of `LightModel`.
  [[nodiscard]] std::optional<LightSample> sample(const LightQuery& query) const;
  [[nodiscard]] float emission_factor(const Imath::V3f& normal, const Imath::V3f& wo, float time) const;
  [[nodiscard]] Imath::V3f emission_direction(const Imath::V3f& normal, Imath::V2f u, float time) const;
  [[nodiscard]] EmissionDensity emission_density(const EmissionQuery& query) const;
  [[nodiscard]] double etendue(double /*across*/) const { return 4 * std::numbers::pi; }
  [[nodiscard]] LightBounds bounds(const Shapes& shapes, double emission) const;
  [[nodiscard]] std::optional<BasicRay<double>> central_ray(const Ball& /*sphere*/) const {
    return BasicRay<double>{position, axis};
  }
  [[nodiscard]] double fan() const { return distribution->max_gamma(); }
  [[nodiscard]] std::size_t memory_bytes() const { return distribution->memory_bytes(); }
};

}  // namespace abbe
