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

/// What every model of a material tells: its scattering at a lookup and the lobes of it; whether that depends
/// on surface coordinates, and on what is outside; whether no light passes through; the index of the matter
/// inside a closed surface, nullptr when light does not enter it, and what else it meets there, if anything;
/// the indices it uses, and the bytes of its images.
template <typename Model>
concept SurfaceModel = requires(const Model& model, const SurfaceLookup& at) {
  { model.bsdf(at) } -> std::same_as<Bsdf>;
  { model.lobes() } -> std::same_as<Lobes>;
  { model.needs_coordinates() } -> std::same_as<bool>;
  { model.depends_on_outside() } -> std::same_as<bool>;
  { model.opaque() } -> std::same_as<bool>;
  { model.interior() } -> std::same_as<const RefractiveIndex*>;
  { model.medium() } -> std::same_as<const Medium*>;
  { model.indices() } -> std::same_as<std::vector<IndexUse>>;
  { model.texture_bytes() } -> std::same_as<std::size_t>;
};

/// The closed list of what surfaces are made of.
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

/// What a surface is made of, over all wavelengths.
struct Material {
  std::string name;
  MaterialModel model;
  std::shared_ptr<const Relief> relief = nullptr;  ///< Turns the normal that scattering sees.
  /// Where matter overlaps, that of the highest priority is there; of equals that of the smallest shape.
  int priority = 0;
};

/// The scattering of `material` at the wavelengths of a packet, against what is outside. It may refer to the
/// material, which must outlive it.
[[nodiscard]] Bsdf make_bsdf(const Material& material, const SurfaceLookup& at);

/// Whether its scattering depends on surface coordinates: by a texture, a relief, or a direction along the
/// surface.
[[nodiscard]] bool needs_coordinates(const Material& material);
/// Tells in which ways light leaves the surface.
[[nodiscard]] Lobes lobes(const Material& material);
/// Sends different wavelengths different ways.
[[nodiscard]] bool is_dispersive(const Material& material);
/// Whether its scattering depends on the matter around it: it has an index.
[[nodiscard]] bool depends_on_outside(const Material& material);
/// The index of the matter inside a closed surface of this material, or nullptr when light does not enter it.
[[nodiscard]] const RefractiveIndex* interior(const Material& material);
/// What light meets inside besides the absorption of that index, or nullptr.
[[nodiscard]] const Medium* medium(const Material& material);
/// Why a dielectric or a pane may not be taken as clear at a wavelength [nm], where its reflectance is that
/// of n alone: with its k it reflects along the normal what differs by more than 1e-4. Nothing of other
/// matter.
[[nodiscard]] std::optional<std::string> clear_fault(const Material& material, double wavelength_nm);
/// Whether no light passes through its surfaces.
[[nodiscard]] bool opaque(const Material& material);
/// The refractive indices it uses, those of coatings too; of a mixture none, as the scene has its components
/// as materials of their own. They refer to the material, which must outlive them.
[[nodiscard]] std::vector<IndexUse> indices(const Material& material);
/// Bytes of the images it looks up.
[[nodiscard]] std::size_t texture_bytes(const Material& material);
/// Whether its surfaces bound matter that light enters, so that they must be closed.
[[nodiscard]] bool encloses_medium(const Material& material);
/// Matter begins and ends at a surface of this material, but light is neither reflected nor refracted there.
[[nodiscard]] bool is_boundary(const Material& material);

}  // namespace abbe
