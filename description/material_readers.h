#pragma once

#include <memory>
#include <optional>
#include <string>

#include "description/load_context.h"
#include "io/object_reader.h"
#include "scene/scene.h"

namespace abbe::description {

// Every measured index lies well inside.
inline constexpr Range kIndex{0, 100, true, false};
inline constexpr Range kMetalIndex{0, 100};  ///< n = 0 is the perfect mirror.

/// A refractive index, and what it is called.
struct Ior {
  std::string name;
  RefractiveIndex index;
  bool constant;
};
/// A number, an object of n and k, or the name of a table; n within `allowed`.
[[nodiscard]] std::optional<Ior> read_ior(const JsonValue& json, Range allowed, LoadContext& context);

/// The `ior` of an object; of a constant real one, `absorption_per_m` may give the absorption beside it.
[[nodiscard]] std::optional<Ior> read_tinted_ior(ObjectReader& reader, LoadContext& context);

/// The layers under a key, none if it is not there.
[[nodiscard]] Coating read_coating(const JsonValue* layers, LoadContext& context);

/// A quantity in [0, 1] over wavelength and surface: a curve, or an image whose channels weigh spectra.
/// Throws Error{input} or Error{resource} for an image file that cannot be read or is too large.
[[nodiscard]] std::optional<SpectralTexture> read_reflectance(const JsonValue& json, LoadContext& context);

/// What is under "normal_map" or "bump_map" of a material, if either is there.
[[nodiscard]] std::shared_ptr<const Relief> read_relief(ObjectReader& reader, LoadContext& context);

/// The facets under a key; none if it is not there or so small that the surface is smooth, and after an
/// error. Reports a rough surface under a coating.
[[nodiscard]] std::optional<Microfacets<float>> read_roughness(const JsonValue* json, const Coating& coating,
                                                               LoadContext& context);
/// `scattering_per_m` and `phase` of an object, and `absorption_per_m` unless its index tells.
[[nodiscard]] std::optional<Medium> read_filling(ObjectReader& reader, bool absorbs, LoadContext& context);

/// Each material of the list from what stands under its key; none after an error.
using MaterialReader = std::optional<MaterialModel> (*)(const JsonValue& json, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> read_diffuse(const JsonValue& json, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> read_dielectric(const JsonValue& json, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> read_conductor(const JsonValue& json, LoadContext& context);
/// Matter without an interface.
[[nodiscard]] std::optional<MaterialModel> read_medium(const JsonValue& json, LoadContext& context);
/// A film with air on both sides, such as a soap bubble's: a coating on nothing.
[[nodiscard]] std::optional<MaterialModel> read_film(const JsonValue& json, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> read_coated_diffuse(const JsonValue& json, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> read_thin_glass(const JsonValue& json, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> read_mirror(const JsonValue& json, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> read_schlick(const JsonValue& json, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> read_oren_nayar(const JsonValue& json, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> read_cosine_power(const JsonValue& json, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> read_phong(const JsonValue& json, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> read_retroreflector(const JsonValue& json, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> read_principled(const JsonValue& json, LoadContext& context);
/// Reads a mixture, whose components are materials of `scene` that are no mixtures.
[[nodiscard]] std::optional<MixtureMaterial> read_mixture(const JsonValue& json, LoadContext& context,
                                                          const Scene& scene);

}  // namespace abbe::description
