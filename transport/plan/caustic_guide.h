#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <ImathBox.h>
#include <ImathVec.h>

#include "spectral/sampled_spectrum.h"

namespace abbe {

/// Photon that arrived by specular events alone at a surface that may scatter it.
struct CausticPhoton {
  Imath::V3f point;             ///< Point of the surface in world space.
  Imath::V3f from;              ///< Unit direction towards its origin.
  float last_distance;          ///< Distance to the last surface before this one [m].
  float path_distance;          ///< Distance to the light along the path [m], which may be infinite.
  float power;                  ///< Sensor-weighted power divided by the number of emitted photons.
  float unoccluded_irradiance;  ///< Unoccluded irradiance of all lights at this point [unit of `power`/m^2].
};

/// Directions from which caustic light arrives at a point: lobes around the directions to points in space, or
/// around constant directions. Refers to its guide, which must outlive it.
class CausticLobes {
 public:
  static constexpr std::size_t kLobesPerPacket = 8;
  /// Several lobes in structure-of-arrays layout, for vector instructions. From a point p a lobe points along
  /// (x, y, z) - near p, with the selection probability `probability`. (x, y, z) is a point in world space
  /// [m], or a unit direction if near is 0. Unused lobes have the probability 0.
  struct LobePacket {
    using Floats = std::array<float, kLobesPerPacket>;
    Floats x{};
    Floats y{};
    Floats z = [] {
      Floats up;
      up.fill(1);  // a valid axis for unused lobes
      return up;
    }();
    Floats near{};  ///< 1, or 0 for a constant direction.
    Floats probability{};
  };

  /// No lobes.
  CausticLobes() = default;
  /// Lobes of the width `width` (a in `CausticGuide`), whose selection probabilities sum to 1. `probability`
  /// is as returned by `probability()`.
  CausticLobes(std::span<const LobePacket> lobes, float width, float probability)
      : lobes_(lobes), width_(width), probability_(probability) {}

  [[nodiscard]] bool empty() const { return lobes_.empty(); }
  /// Probability with which a path draws an additional direction from the lobes; 0 without lobes.
  [[nodiscard]] float probability() const { return probability_; }
  /// These lobes with `probability()` multiplied by `factor`.
  [[nodiscard]] CausticLobes scaled(float factor) const { return {lobes_, width_, probability_ * factor}; }
  /// Samples a unit direction from a point in world space: `lobe` in [0, 1) selects the lobe, `u` in [0, 1)^2
  /// the direction. There must be lobes.
  [[nodiscard]] Imath::V3f sample(const Imath::V3f& point, float lobe, Imath::V2f u) const;
  /// Pdf [1/sr] with which `sample` returns a unit direction from `point`; 0 without lobes.
  [[nodiscard]] float pdf(const Imath::V3f& point, const Imath::V3f& direction) const;
  /// Summed pdf [1/sr], per wavelength, of a direction over all paths that leave the vertex: one with the pdf
  /// `scattering` [1/sr], and on average `probability()` from the lobes. The lobes count only for wavelengths
  /// that scattering can send there.
  [[nodiscard]] SampledSpectrum combined_pdf(const SampledSpectrum& scattering, const Imath::V3f& point,
                                             const Imath::V3f& direction) const {
    const float added = probability_ * pdf(point, direction);
    return SampledSpectrum::map(scattering, [added](float s) { return s > 0 ? s + added : 0; });
  }

 private:
  std::span<const LobePacket> lobes_;
  float width_ = 0;
  float probability_ = 0;
};

/// Guide for camera paths to caustics, trained with photons [Jensen1995]. Space is halved until few photons
/// remain per region. Each photon of a region is the axis of a lobe
///     p(w) = a^2 / (pi (a^2 + tan^2 t)^2 cos^3 t),
/// with the angle t between w and the axis. The width a follows from how well the axes of the other photons
/// predict each photon's direction. The direction to a light varies within a region, so an axis points to a
/// point on its photon's path [Ruppert2020]. This is the last surface before the hit, or a point at the
/// distance of the light, where flat mirrors show its image. The choice with the sharper lobes is used.
class CausticGuide {
 public:
  /// Guide without lobes.
  CausticGuide() = default;
  /// Builds the guide. `scene` is the bounding box of the shapes [m], which is divided into cells. Photons
  /// whose power is not positive and finite are ignored; fewer than eight others give an empty guide.
  CausticGuide(std::vector<CausticPhoton> photons, const Imath::Box3d& scene);

  /// True if no region has lobes.
  [[nodiscard]] bool empty() const { return regions_.empty(); }
  /// Lobes at a point in world space. Empty if no caustics are known there, or if they arrive from such a
  /// wide angle that scattering samples them.
  [[nodiscard]] CausticLobes at(const Imath::V3f& point) const;

 private:
  // Lobes from index `first` on, and the box in which they are valid.
  struct Region {
    Imath::Box3f box;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    float width = 0;
    float probability = 0;
  };
  // Divides space at `at` along `axis`: the next node is below, node `above` is above. A leaf has axis -1.
  struct Node {
    float at = 0;
    int axis = -1;
    std::uint32_t above = 0;
    std::uint32_t region = 0;
  };

  // Cell of space with its photons, and those of the smallest enclosing cell that has enough.
  struct Cell {
    std::span<CausticPhoton> photons;
    std::span<const CausticPhoton> fallback;
    Imath::Box3f box;
    int depth;
  };

  void build(Cell cell);
  void add_region(std::span<const CausticPhoton> region_photons);

  std::vector<Node> nodes_;
  std::vector<Region> regions_;
  std::vector<CausticLobes::LobePacket> lobes_;
};

}  // namespace abbe
