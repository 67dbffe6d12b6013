#pragma once

#include <variant>
#include <vector>

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/medium/medium.h"
#include "materials/model/index_use.h"

namespace abbe {

/// The part common to all thin elements. `SurfaceModel` describes the member functions.
struct ThinElementMaterial {
  Curve transmittance;  ///< In [0, 1]; the model defines for which light.

  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] static constexpr bool depends_on_outside() { return false; }
  [[nodiscard]] static constexpr bool opaque() { return false; }
  [[nodiscard]] static constexpr const RefractiveIndex* interior_index() { return nullptr; }
  [[nodiscard]] static constexpr const Medium* medium() { return nullptr; }
  [[nodiscard]] static std::vector<IndexUse> indices() { return {}; }
  [[nodiscard]] static constexpr std::size_t texture_bytes() { return 0; }
};

/// A unit vector in the surface at an angle [rad] from u, counterclockwise for a viewer outside.
[[nodiscard]] Imath::V2d surface_axis(double angle);

/// A linear polariser; `transmittance` is that of light polarised along its axis.
struct PolariserMaterial : ThinElementMaterial {
  Curve
      blocked;   ///< Transmittance perpendicular to the axis divided by that along it, in [0, 1]; 0 is ideal.
  double angle;  ///< Angle of the transmission axis [rad].

  /// Transmittance for unpolarised light.
  [[nodiscard]] double mean_transmittance(double wavelength_nm) const {
    return transmittance(wavelength_nm) * (1 + blocked(wavelength_nm)) / 2;
  }
  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr bool needs_coordinates() { return true; }
};

/// A wave plate: ideal, or a birefringent plate with perfect antireflection coatings.
struct WavePlateMaterial : ThinElementMaterial {
  struct Ideal {
    double retardance;  ///< Retardance at all wavelengths [rad].
  };
  struct Crystal {
    double thickness;     ///< Thickness of the plate [m].
    Curve birefringence;  ///< Index of the slow axis minus that of the fast axis, relative to air; 0 or more.
  };
  std::variant<Ideal, Crystal> kind;
  double angle;  ///< Angle of the fast axis [rad].

  /// Phase lag of fields perpendicular to the fast axis [rad]: 2 pi Delta n d/lambda along the normal. The
  /// plate is treated as thin, so the value holds for all directions.
  [[nodiscard]] double retardance(double wavelength_nm) const;
  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr bool needs_coordinates() { return true; }
};

/// A sheet that depolarises light.
struct DepolariserMaterial : ThinElementMaterial {
  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr bool needs_coordinates() { return false; }
};

}  // namespace abbe
