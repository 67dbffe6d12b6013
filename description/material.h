#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/index.h"
#include "description/meshes/mesh_file.h"
#include "description/reflectance.h"
#include "scene/scene.h"

namespace abbe::spec {

enum class PhaseWord { isotropic, rayleigh };
struct HenyeyGreenstein {
  double g = 0;  ///< Mean cosine of the scattering angle.
};
/// Scattering of a medium.
struct Scattering {
  std::optional<Curve> per_m;  ///< Scattering coefficient [1/m].
  std::optional<schema::Located<std::variant<PhaseWord, HenyeyGreenstein>>> phase;
};
/// A grid of densities at its nodes, which multiply absorption and scattering.
struct Grid {
  schema::Located<std::string> densities;
  Imath::V3d from{0, 0, 0};
  Imath::V3d to{0, 0, 0};
  SourcePosition where;
};

struct Diffuse {
  Reflectance reflectance;
};
struct Dielectric {
  TintedIor ior;
  Scattering scattering;
  std::vector<LayerEntry> coating;
  std::optional<Roughness> roughness;
};
struct Conductor {
  Ior ior;
  std::vector<LayerEntry> coating;
  std::optional<Roughness> roughness;
};
/// Thin films with the same medium on both sides, such as a soap bubble: a coating without a substrate.
struct Film {
  std::vector<LayerEntry> layers;
};
/// A medium without an interface.
struct Medium {
  std::optional<Curve> absorption_per_m;
  Scattering scattering;
  std::optional<Grid> grid;
};
struct CoatedDiffuse {
  Ior ior;
  Reflectance reflectance;
};
struct ThinGlass {
  TintedIor ior;
  double thickness = 0;
};
struct Mirror {
  Reflectance reflectance;
};
struct Schlick {
  std::variant<std::monostate, Ior, Reflectance> normal;
};
struct OrenNayar {
  Reflectance reflectance;
  double sigma_deg = 0;
};
struct Principled {
  Reflectance base_color;
  double metallic = 0;
  double roughness = 0.5;
  double specular = 0.5;
  double sheen = 0;
  double clearcoat = 0;
  double clearcoat_gloss = 1;
};
/// Parameters of all models that are powers of a cosine.
struct Power {
  Reflectance reflectance;
  double exponent = 0;
};
struct CosinePower : Power {
  bool reciprocal = false;
};
struct Phong : Power {};
struct Retroreflector : Power {};
/// Parameters of all thin elements.
struct ThinElement {
  std::optional<Curve> transmittance;
};
struct Polariser : ThinElement {
  std::optional<Curve> extinction_ratio;
  double angle_deg = 0;
};
struct Retardance {
  double retardance_deg = 0;
};
struct Crystal {
  double thickness = 0;
  Curve birefringence;
};
struct WavePlate : ThinElement {
  std::variant<std::monostate, Retardance, Crystal> kind;
  double angle_deg = 0;
};
struct Depolariser : ThinElement {};
[[nodiscard]] schema::Fields fields(schema::Tag<Polariser>);
[[nodiscard]] schema::Fields fields(schema::Tag<WavePlate>);
[[nodiscard]] schema::Fields fields(schema::Tag<Depolariser>);
struct MixturePart {
  schema::Located<std::string> material;
  Curve weight;
};
struct Mixture : schema::Located<std::vector<MixturePart>> {};

struct NormalMap {
  TextureFile file;
};
struct BumpMap {
  TextureFile file;
  double height = 0;
};
struct Material {
  std::variant<std::monostate, Mixture, Diffuse, Dielectric, Conductor, Film, Medium, CoatedDiffuse,
               ThinGlass, Mirror, Schlick, OrenNayar, Principled, CosinePower, Phong, Retroreflector,
               Polariser, WavePlate, Depolariser>
      model;
  std::optional<schema::Located<int>> priority;
  std::variant<std::monostate, NormalMap, BumpMap> relief;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Material>);
[[nodiscard]] schema::ValueType materials();

using Materials = std::vector<schema::Named<Material>>;

}  // namespace abbe::spec

namespace abbe::description {

/// Adds all materials to the scene. A material with an error becomes black, so that references to it cause no
/// second error.
void build_materials(const spec::Materials& materials, LoadContext& context, Scene& scene);
/// Builds the model of a material; nothing after an error. A mixture is still without its components.
[[nodiscard]] std::optional<MaterialModel> build_model(const spec::Material& material, LoadContext& context);
/// Index of the material of that name. Reports an unknown name with the nearest known one.
[[nodiscard]] std::optional<std::uint32_t> find_material(const schema::Located<std::string>& name,
                                                         LoadContext& context, const Scene& scene);
/// Index in the scene of a material of a mesh file, added as "FILE:NAME" if it is new. One warning lists the
/// features of it that are not represented.
[[nodiscard]] std::uint32_t add_file_material(const FileMaterial& material, const std::string& file,
                                              const SourcePosition& at, LoadContext& context, Scene& scene);
/// Index of the material of lights that name none: diffuse with reflectance 0.
[[nodiscard]] std::uint32_t black_material(LoadContext& context, Scene& scene);

/// Builds the medium inside a shape. Reports the errors of its curves; returns nothing after an error.
[[nodiscard]] std::optional<Medium> build(const spec::Scattering& scattering,
                                          const std::optional<spec::Curve>& absorption, LoadContext& context);
/// Reads a grid of densities; positions in metres. Returns nothing after an error.
[[nodiscard]] std::optional<PlacedGrid> build(const spec::Grid& grid, LoadContext& context);
/// The three thin elements. Return nothing after an error, such as a curve outside its allowed range.
[[nodiscard]] std::optional<MaterialModel> build(const spec::Polariser& polariser, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> build(const spec::WavePlate& plate, LoadContext& context);
[[nodiscard]] std::optional<MaterialModel> build(const spec::Depolariser& sheet, LoadContext& context);
/// Builds a mixture of materials of `scene`. Its components must be neither mixtures nor media. Returns
/// nothing after an error.
[[nodiscard]] std::optional<MixtureMaterial> build(const spec::Mixture& mixture, LoadContext& context,
                                                   const Scene& scene);
/// Reads a normal map or a bump map. Returns nullptr after an error.
[[nodiscard]] std::shared_ptr<const Relief> build(const spec::NormalMap& map, LoadContext& context);
[[nodiscard]] std::shared_ptr<const Relief> build(const spec::BumpMap& map, LoadContext& context);

}  // namespace abbe::description
