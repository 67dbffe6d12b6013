#pragma once

#include <concepts>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "materials/model/classic.h"
#include "materials/model/layered.h"
#include "materials/model/medium_material.h"
#include "materials/model/mixture.h"
#include "materials/model/principled.h"
#include "materials/model/rough.h"
#include "materials/model/smooth.h"
#include "materials/model/thin_element.h"
#include "materials/texture/relief.h"

namespace abbe {

/// Interface of the models in `MaterialModel`.
/// - `bsdf`: the scattering at a lookup, which may refer to the model; `lobes`: its kinds of lobes.
/// - `needs_coordinates`: true if the scattering depends on surface coordinates; `depends_on_outside`: true
///   if it depends on the index outside.
/// - `opaque`: true if no light passes through the surface.
/// - `interior_index`: the index inside a closed surface, or nullptr if light does not enter.
/// - `medium`: the medium inside that absorbs or scatters in addition to `interior_index`, or nullptr.
/// - `indices`: all refractive indices that the model uses, except those of a mixture's components;
///   `texture_bytes`: the size of its images in bytes.
template <typename Model>
concept SurfaceModel = requires(const Model& model, const SurfaceLookup& at) {
  { model.bsdf(at) } -> std::same_as<Bsdf>;
  { model.lobes() } -> std::same_as<Lobes>;
  { model.needs_coordinates() } -> std::same_as<bool>;
  { model.depends_on_outside() } -> std::same_as<bool>;
  { model.opaque() } -> std::same_as<bool>;
  { model.interior_index() } -> std::same_as<const RefractiveIndex*>;
  { model.medium() } -> std::same_as<const Medium*>;
  { model.indices() } -> std::same_as<std::vector<IndexUse>>;
  { model.texture_bytes() } -> std::same_as<std::size_t>;
};

/// The closed list of material models.
using MaterialModel =
    std::variant<DiffuseMaterial, DielectricMaterial, FilmMaterial, ConductorMaterial,
                 RoughDielectricMaterial, RoughConductorMaterial, MediumMaterial, CoatedDiffuseMaterial,
                 ThinGlassMaterial, MixtureMaterial, MirrorMaterial, SchlickMaterial, OrenNayarMaterial,
                 PrincipledMaterial, CosinePowerMaterial, PhongMaterial, RetroreflectorMaterial,
                 PolariserMaterial, WavePlateMaterial, DepolariserMaterial>;

/// True if `List` is a variant whose types all satisfy `SurfaceModel`.
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
/// An error message if the renderer may not treat a dielectric or thin glass as clear at a wavelength [nm].
/// The renderer uses n alone for its reflectance; the message is given if k changes the reflectance along the
/// normal by more than 1e-4. Empty otherwise and for other materials.
[[nodiscard]] std::optional<std::string> transparency_fault(const Material& material, double wavelength_nm);
/// True if no light passes through the surface.
[[nodiscard]] bool opaque(const Material& material);
/// All refractive indices that the material uses, including those of coatings. Empty for a mixture, because
/// the scene lists its components as materials of their own. The result refers to the material, which must
/// outlive it.
[[nodiscard]] std::vector<IndexUse> indices(const Material& material);
/// Size of the material's images in bytes, including a relief.
[[nodiscard]] std::size_t texture_bytes(const Material& material);
/// True if the surface bounds a medium that light enters. Such a surface must be closed.
[[nodiscard]] bool encloses_medium(const Material& material);
/// True if a medium begins and ends at the surface without reflection or refraction.
[[nodiscard]] bool is_boundary(const Material& material);

}  // namespace abbe
