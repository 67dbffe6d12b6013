#pragma once

#include <memory>
#include <string>
#include <variant>

#include "materials/model/classic.h"
#include "materials/model/layered.h"
#include "materials/model/medium_material.h"
#include "materials/model/mixture.h"
#include "materials/model/principled.h"
#include "materials/model/rough.h"
#include "materials/model/smooth.h"
#include "materials/texture/relief.h"

namespace abbe {

/// The closed list of what surfaces are made of. Each model tells its `bsdf` at a lookup and its `lobes`, and
/// its `interior` if light enters the closed surface, its `matter` if what is inside may scatter,
/// `needs_coordinates` if its scattering may depend on them.
using MaterialModel =
    std::variant<DiffuseMaterial, DielectricMaterial, ConductorMaterial, RoughDielectricMaterial,
                 RoughConductorMaterial, MediumMaterial, CoatedDiffuseMaterial, ThinGlassMaterial,
                 MixtureMaterial, MirrorMaterial, SchlickMaterial, OrenNayarMaterial, PrincipledMaterial,
                 CosinePowerMaterial, PhongMaterial, RetroreflectorMaterial>;

/// What a surface is made of, over all wavelengths.
struct Material {
  std::string name;
  MaterialModel model;
  std::shared_ptr<const Relief> relief = nullptr;  ///< Turns the normal that scattering sees.
  /// Where matter overlaps, that of the highest priority is there; of equals that which light enters last.
  int priority = 0;
};

/// The scattering of `material` at the wavelengths of a packet, against what is outside. It may refer to the
/// material, which must outlive it.
[[nodiscard]] Bsdf make_bsdf(const Material& material, const SurfaceLookup& at);

/// Whether its scattering depends on surface coordinates: by a texture, a relief, or a direction along the
/// surface.
[[nodiscard]] bool needs_coordinates(const Material& material);
/// In which ways light leaves it.
[[nodiscard]] Lobes lobes(const Material& material);
/// Sends different wavelengths different ways.
[[nodiscard]] bool is_dispersive(const Material& material);
/// Whether it scatters otherwise in other matter: it has an index.
[[nodiscard]] bool depends_on_outside(const Material& material);
/// The index of the matter inside a closed surface of this material, or nullptr when light does not enter it.
[[nodiscard]] const RefractiveIndex* interior(const Material& material);
/// What light meets inside besides the absorption of that index, or nullptr.
[[nodiscard]] const Medium* medium(const Material& material);
/// Whether its surfaces bound matter that light enters, so that they must be closed.
[[nodiscard]] bool encloses_medium(const Material& material);
/// Matter begins and ends at a surface of this material, but light is neither reflected nor refracted there.
[[nodiscard]] bool is_boundary(const Material& material);

}  // namespace abbe
