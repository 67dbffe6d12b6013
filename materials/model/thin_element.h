#pragma once

#include <variant>
#include <vector>

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/medium/medium.h"
#include "materials/model/index_use.h"

namespace abbe {

/// What all thin elements answer alike.
struct ThinElementMaterial {
  Curve transmittance;  ///< In [0, 1]; of which light, the model says.

  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] static constexpr bool depends_on_outside() { return false; }
  [[nodiscard]] static constexpr bool opaque() { return false; }
  [[nodiscard]] static constexpr const RefractiveIndex* interior() { return nullptr; }
  [[nodiscard]] static constexpr const Medium* medium() { return nullptr; }
  [[nodiscard]] static std::vector<IndexUse> indices() { return {}; }
  [[nodiscard]] static constexpr std::size_t texture_bytes() { return 0; }
};

/// A unit vector in a surface, x being along u, at an angle [rad] counterclockwise as seen from outside.
[[nodiscard]] Imath::V2d surface_axis(double angle);

/// A linear polariser. `transmittance` is that of light polarised along its axis.
struct PolariserMaterial : ThinElementMaterial {
  Curve blocked;  ///< Transmittance across the axis over that along it, in [0, 1]; 0 is ideal.
  double angle;   ///< Of the axis along which fields pass [rad].

  /// Of light that is not polarised.
  [[nodiscard]] double mean_transmittance(double wavelength_nm) const {
    return transmittance(wavelength_nm) * (1 + blocked(wavelength_nm)) / 2;
  }
  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr bool needs_coordinates() { return true; }
};

/// A wave plate: ideal, or a plate of birefringent matter between perfect coatings.
struct WavePlateMaterial : ThinElementMaterial {
  struct Ideal {
    double retardance;  ///< [rad], at all wavelengths.
  };
  struct Crystal {
    double thickness;     ///< [m]
    Curve birefringence;  ///< The slow axis's index less the fast one's, relative to air; 0 or more.
  };
  std::variant<Ideal, Crystal> kind;
  double angle;  ///< Of its fast axis [rad].

  /// By how much fields across the fast axis lag behind [rad]: 2 pi Delta n d/lambda, for light along the
  /// normal and, as the plate is taken to be thin, for all other too.
  [[nodiscard]] double retardance(double wavelength_nm) const;
  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr bool needs_coordinates() { return true; }
};

/// What makes unpolarised light of any.
struct DepolariserMaterial : ThinElementMaterial {
  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr bool needs_coordinates() { return false; }
};

}  // namespace abbe
