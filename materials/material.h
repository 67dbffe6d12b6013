#pragma once

#include <concepts>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "materials/bsdf.h"
#include "materials/bsdf/surface.h"
#include "materials/texture/texture_image.h"

namespace abbe {

template <BsdfModel Model>
[[nodiscard]] Bsdf as_bsdf(const Model& model) {
  return model;
}
template <BsdfModel... Models>
[[nodiscard]] Bsdf as_bsdf(const std::variant<Models...>& either) {
  return std::visit([](const auto& model) -> Bsdf { return model; }, either);
}

/// A model that has no delta lobes, or whose delta lobes have a power and a Mueller matrix.
template <typename Model>
concept DescribesDeltaLobes = !Model::lobes().delta || requires(const Model& model, const SmoothLookup& ray) {
  model.smooth_power(ray);
  model.smooth_mueller(ray);
};

/// Interface of the models in `MaterialModel`. The free functions of these names below describe most of them.
/// - Required: `lobes`, and `bsdf`, the scattering at a lookup, which may refer to the model. It is a
///   `BsdfModel` or a variant of several.
/// - Required if it has delta lobes: `smooth_power`, and `smooth_mueller`, called only if that is not empty.
/// - Optional, false if absent: `needs_coordinates`, `depends_on_outside`, `opaque` and
///   `preserves_polarisation`.
/// - Optional: `polarises`; if absent, true for delta lobes that do not preserve polarisation.
/// - Optional, nullptr or empty if absent: `interior_index`; `clear_index`, the index of a sheet that light
///   does not enter but crosses; `medium`; `indices`; `texture_bytes`.
template <typename Model>
concept SurfaceModel = requires(const Model& model, const SurfaceLookup& at) {
  { as_bsdf(model.bsdf(at)) } -> std::same_as<Bsdf>;
  { model.lobes() } -> std::same_as<Lobes>;
  requires DescribesDeltaLobes<Model>;
};

using MaterialModel =
    std::variant<DiffuseMaterial, DielectricMaterial, FilmMaterial, ConductorMaterial,
                 RoughDielectricMaterial, RoughConductorMaterial, MediumMaterial, CoatedDiffuseMaterial,
                 ThinGlassMaterial, MixtureMaterial, MirrorMaterial, SchlickMaterial, OrenNayarMaterial,
                 PrincipledMaterial, CosinePowerMaterial, PhongMaterial, RetroreflectorMaterial,
                 PolariserMaterial, WavePlateMaterial, DepolariserMaterial>;

template <typename List>
inline constexpr bool kAllSurfaceModels = false;
template <typename... Models>
inline constexpr bool kAllSurfaceModels<std::variant<Models...>> = (SurfaceModel<Models> && ...);
static_assert(kAllSurfaceModels<MaterialModel>);

/// The material of a surface, for all wavelengths.
struct Material {
  std::string name;
  MaterialModel model;
  std::shared_ptr<const Relief> relief = nullptr;  ///< Perturbs the shading normal; nullptr for none.
  /// Rank of the medium inside. Where media overlap, that of the largest number prevails; among equals, that
  /// of the smallest shape.
  int priority = 0;
};

/// The BSDF of `material` at the wavelengths of a lookup, relative to the medium outside. Relief is not
/// included. It may refer to the material, which must outlive it.
[[nodiscard]] Bsdf make_bsdf(const Material& material, const SurfaceLookup& at);

/// True if the scattering depends on surface coordinates: through a texture, a relief or a direction along
/// the surface.
[[nodiscard]] bool needs_coordinates(const Material& material);
/// The kinds of lobes into which the surface scatters.
[[nodiscard]] Lobes lobes(const Material& material);
/// True if the index inside the surface depends on wavelength, so that refraction disperses light.
[[nodiscard]] bool is_dispersive(const Material& material);
/// True if the scattering depends on the index of the medium outside.
[[nodiscard]] bool depends_on_outside(const Material& material);
/// The refractive index inside a closed surface of this material, or nullptr if light does not enter it.
[[nodiscard]] const RefractiveIndex* interior_index(const Material& material);
/// The medium inside that absorbs or scatters in addition to the absorption of that index, or nullptr.
[[nodiscard]] const Medium* medium(const Material& material);
/// An error message for a dielectric or thin glass whose k changes the reflectance along the normal by more
/// than 1e-4 at a wavelength [nm]; the renderer uses n alone. Empty otherwise and for other materials.
[[nodiscard]] std::optional<std::string> transparency_fault(const Material& material, double wavelength_nm);
/// True if the surface may polarise unpolarised light.
[[nodiscard]] bool polarises(const Material& material);
/// True if the surface may preserve the polarisation of polarised light although it leaves unpolarised light
/// unpolarised, as ideal mirrors do.
[[nodiscard]] bool preserves_polarisation(const Material& material);
/// True if no light passes through the surface.
[[nodiscard]] bool opaque(const Material& material);
/// All refractive indices that the material uses, including those of coatings; the material must outlive
/// them. Empty for a mixture, because the scene lists its components as materials of their own.
[[nodiscard]] std::vector<IndexUse> indices(const Material& material);
/// Size of the material's images in bytes, including a relief.
[[nodiscard]] std::size_t texture_bytes(const Material& material);
/// True if the surface bounds a medium that light enters. Such a surface must be closed.
[[nodiscard]] bool encloses_medium(const Material& material);
/// True if a medium begins and ends at the surface without reflection or refraction.
[[nodiscard]] bool is_boundary(const Material& material);

/// Reflectance and transmittance of the delta lobes, in double precision by the formulas of the model. T is
/// the power that crosses the surface; it is 0 if the surface is opaque. A model without polarisation returns
/// equal values for s and p. A mixture adds up its components with their weights and leaves out those without
/// a result. Empty if the material has no delta lobe, or if a textured value is needed at unknown
/// coordinates.
[[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const Material& material,
                                                               const SmoothLookup& at);

/// Mueller matrices of the delta lobes; empty if `smooth_power` is empty.
[[nodiscard]] std::optional<SmoothMueller> smooth_mueller(const Material& material, const SmoothLookup& at);

}  // namespace abbe
