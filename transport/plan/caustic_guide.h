#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <ImathBox.h>
#include <ImathVec.h>

#include "spectral/packet.h"

namespace abbe {

/// A photon that came through specular matter alone to where it may scatter.
struct CausticPhoton {
  Imath::V3f point;
  Imath::V3f from;       ///< The unit direction to where it came from.
  float last_distance;   ///< To the surface that sent it here [m],
  float whole_distance;  ///< and to its light along the way it took, perhaps infinite.
  float power;           ///< Over the number of photons that set out.
  float unhindered;      ///< Irradiance here [power/m^2] of all lights, were nothing in between.
};

/// Directions in which to look for light that comes to a place through specular matter: lobes around the
/// directions to some points in space, or of some rays. Refers to its guide.
class CausticLobes {
 public:
  static constexpr std::size_t kTogether = 8;
  /// Some lobes, number by number, so that a processor takes all of them at once. From a point p a lobe
  /// points along (x, y, z) - near p, and is chosen with the probability `share`. One that is not there has
  /// none.
  struct Lobes {
    using Numbers = std::array<float, kTogether>;
    Numbers x{};
    Numbers y{};
    Numbers z = [] {
      Numbers up;
      up.fill(1);  // so that those that are not there have an axis as well
      return up;
    }();
    Numbers near{};  ///< 1, or 0 of a lobe that points the same way from everywhere.
    Numbers share{};
  };

  CausticLobes() = default;
  CausticLobes(std::span<const Lobes> lobes, float width, float share)
      : lobes_(lobes), width_(width), share_(share) {}

  [[nodiscard]] bool empty() const { return lobes_.empty(); }
  /// Probability that a path draws an additional direction from the lobes.
  [[nodiscard]] float share() const { return share_; }
  /// These lobes with their selection probability multiplied by `factor`.
  [[nodiscard]] CausticLobes scaled(float factor) const { return {lobes_, width_, share_ * factor}; }
  /// A direction to look in from a point, by `lobe` and `u` in [0, 1).
  [[nodiscard]] Imath::V3f sample(const Imath::V3f& point, float lobe, Imath::V2f u) const;
  /// Its density [1/sr], of any unit direction.
  [[nodiscard]] float pdf(const Imath::V3f& point, const Imath::V3f& direction) const;
  /// Density of a direction [1/sr], wavelength by wavelength, among all directions that a path is followed
  /// in: one of the density `scattering`, and `share()` on average from the lobes. The lobes count only for
  /// wavelengths that scattering can send there.
  [[nodiscard]] SampledSpectrum combined_pdf(const SampledSpectrum& scattering, const Imath::V3f& point,
                                             const Imath::V3f& direction) const {
    const float added = share_ * pdf(point, direction);
    return SampledSpectrum::map(scattering, [added](float s) { return s > 0 ? s + added : 0; });
  }

 private:
  std::span<const Lobes> lobes_;
  float width_ = 0;
  float share_ = 0;
};

/// Tells from where caustics come at a place, as photons have shown [Jensen1995]: space is halved until few
/// photons share a region, and each of a region's is the axis of a lobe
///     p(w) = a^2 / (pi (a^2 + tan^2 t)^2 cos^3 t),
/// t being the angle between w and the axis, whose width a is told by how well the axes of the other photons
/// predict each one's direction. As a lamp is seen elsewhere from another place of a region, an axis points
/// to a point of its photon's way [Ruppert2020]: to where it left the last surface, or as far away as its
/// light, where flat mirrors show it, whichever leaves the lobes of a region sharper.
class CausticGuide {
 public:
  CausticGuide() = default;
  /// `scene` is a box around the shapes, which cells of space are divided from.
  CausticGuide(std::vector<CausticPhoton> photons, const Imath::Box3d& scene);

  /// Whether there is nothing to look for anywhere.
  [[nodiscard]] bool empty() const { return regions_.empty(); }
  /// The lobes at a point; none where no caustics are known, or where they come from so wide around that
  /// scattering finds them.
  [[nodiscard]] CausticLobes at(const Imath::V3f& point) const;

 private:
  // Lobes from `first` on, and the box that says how far they may be asked.
  struct Region {
    Imath::Box3f box;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    float width = 0;
    float share = 0;
  };
  // Halves space at `at` along `axis`; below it the next node, above it `above`. A leaf has no axis.
  struct Node {
    float at = 0;
    int axis = -1;
    std::uint32_t above = 0;
    std::uint32_t region = 0;
  };

  // A part of space, its photons, and those of the smallest part around it that has enough.
  struct Cell {
    std::span<CausticPhoton> photons;
    std::span<const CausticPhoton> around;
    Imath::Box3f box;
    int depth;
  };

  void build(Cell cell);
  void add_region(std::span<const CausticPhoton> all);

  std::vector<Node> nodes_;
  std::vector<Region> regions_;
  std::vector<CausticLobes::Lobes> lobes_;
};

}  // namespace abbe
