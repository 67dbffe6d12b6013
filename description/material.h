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

// Materials as scene files describe them. Lengths are in the scene file's unit; reflectances, transmittances
// and weights are in [0, 1]. "Outside" is the side of the front, to which the normal points.

/// Phase functions without parameters.
enum class PhaseWord { isotropic, rayleigh };
struct HenyeyGreenstein {
  double g = 0;  ///< Mean cosine of the scattering angle, in [-0.9999, 0.9999]; positive scatters forwards.
};
/// Scattering of a medium: coefficient [1/m], 0 if absent, and phase function, isotropic if absent.
struct Scattering {
  std::optional<Curve> per_m;
  std::optional<schema::Located<std::variant<PhaseWord, HenyeyGreenstein>>> phase;
};
/// A grid of densities at its nodes, which multiply absorption and scattering.
struct Grid {
  schema::Located<std::string> densities;  ///< A NumPy file with the axes z, y, x and values in [0, 1e9].
  Imath::V3d from{0, 0, 0};                ///< Position of the first node.
  Imath::V3d to{0, 0, 0};  ///< Position of the last node, greater than `from` along each axis.
  SourcePosition where;
};

/// Lambertian reflection on both sides.
struct Diffuse {
  Reflectance reflectance;
};
/// An interface between the medium inside a closed shape and the medium around it.
struct Dielectric {
  TintedIor ior;
  Scattering scattering;
  std::vector<LayerEntry> coating;     ///< Thin films, from the outside inwards; none if empty.
  std::optional<Roughness> roughness;  ///< Smooth if absent; not allowed with a coating.
};
/// An opaque metal.
struct Conductor {
  Ior ior;
  std::vector<LayerEntry> coating;
  std::optional<Roughness> roughness;
};
/// Thin films with the same medium on both sides, such as a soap bubble: a coating without a substrate.
struct Film {
  std::vector<LayerEntry> layers;
};
/// A medium without an interface, such as fog.
struct Medium {
  std::optional<Curve> absorption_per_m;  ///< Absorption coefficient, 0 or more; 0 if absent.
  Scattering scattering;
  std::optional<Grid> grid;  ///< Density 1 everywhere if absent.
};
/// A Lambertian base under a smooth clear coat.
struct CoatedDiffuse {
  Ior ior;                  ///< Index of the coat, with n of 1 or more and practically no k.
  Reflectance reflectance;  ///< Reflectance of the base without its coat.
};
/// A pane modelled as one surface, which light crosses without deflection.
struct ThinGlass {
  TintedIor ior;
  double thickness = 0;  ///< 0 for no absorption.
};
/// An ideal mirror, with the same reflectance at every angle.
struct Mirror {
  Reflectance reflectance;
};
/// A smooth mirror with Schlick's approximation.
struct Schlick {
  /// Reflectance at normal incidence, or the index from which it follows.
  std::variant<std::monostate, Ior, Reflectance> normal;
};
/// Oren and Nayar's rough diffuse surface.
struct OrenNayar {
  Reflectance reflectance;
  double sigma_deg = 0;  ///< Standard deviation of the facets' slope angles, in [0, 90].
};
/// Burley's principled model. All numbers are in [0, 1].
struct Principled {
  Reflectance base_color;
  double metallic = 0;         ///< Fraction of metallic reflection.
  double roughness = 0.5;      ///< The microfacet alpha is its square.
  double specular = 0.5;       ///< Reflectance of the non-metallic part at normal incidence, divided by 0.08.
  double sheen = 0;            ///< Strength of a cloth-like sheen at grazing angles.
  double clearcoat = 0;        ///< Strength of a second highlight.
  double clearcoat_gloss = 1;  ///< Gloss of the second highlight; larger is narrower.
};
/// Parameters of all models that are powers of a cosine.
struct Power {
  Reflectance reflectance;
  double exponent = 0;  ///< Power of the cosine, in [0, 1e4].
};
/// A power of the cosine of the direction of light to the normal.
struct CosinePower : Power {
  bool reciprocal = false;  ///< True to apply the power to the cosines of both directions.
};
struct Phong : Power {};           ///< Phong's highlight around the mirror direction.
struct Retroreflector : Power {};  ///< A lobe around the direction from which light comes.
/// Parameters of all thin elements: surfaces that light crosses without deflection.
struct ThinElement {
  std::optional<Curve> transmittance;  ///< 1 if absent. That of a polariser is along its axis.
};
/// A linear polariser.
struct Polariser : ThinElement {
  /// Transmittance along the axis over that across it, 1 or more; infinite if absent.
  std::optional<Curve> extinction_ratio;
  /// Angle of the axis to the surface coordinate u, counter-clockwise if viewed from outside.
  double angle_deg = 0;
};
/// A retardance that is the same at all wavelengths.
struct Retardance {
  double retardance_deg = 0;  ///< Phase lag of the field across the fast axis.
};
/// A plate of a birefringent crystal.
struct Crystal {
  double thickness = 0;
  Curve birefringence;  ///< Index along the slow axis minus that along the fast axis, in [0, 10].
};
struct WavePlate : ThinElement {
  std::variant<std::monostate, Retardance, Crystal> kind;
  double angle_deg = 0;  ///< Angle of the fast axis to u, counter-clockwise if viewed from outside.
};
struct Depolariser : ThinElement {};
/// A component of a mixture.
struct MixturePart {
  schema::Located<std::string> material;  ///< Name of a material that is no mixture and has no medium inside.
  Curve weight;
};
/// Materials side by side. At each wavelength their weights add up to at most 1.
struct Mixture : schema::Located<std::vector<MixturePart>> {};

/// An image with channels R, G, B in [0, 1], which encode [-1, 1] along u, v and the outward normal.
struct NormalMap {
  TextureFile file;
};
/// An image with one channel of heights above the surface.
struct BumpMap {
  TextureFile file;
  double height = 0;  ///< Height for a value of 1.
};
/// A material of a scene file. `std::monostate` means that no model was read, or that there is no relief.
struct Material {
  std::variant<std::monostate, Mixture, Diffuse, Dielectric, Conductor, Film, Medium, CoatedDiffuse,
               ThinGlass, Mirror, Schlick, OrenNayar, Principled, CosinePower, Phong, Retroreflector,
               Polariser, WavePlate, Depolariser>
      model;
  std::optional<schema::Located<int>> priority;  ///< In [-1000, 1000]; 0 if absent.
  std::variant<std::monostate, NormalMap, BumpMap> relief;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Material>);
/// The form in which scene files write materials: an object of materials by name.
[[nodiscard]] schema::ValueType materials();

using Materials = std::vector<schema::Named<Material>>;

}  // namespace abbe::spec

namespace abbe::description {

// Functions report errors to `context.diagnostics`. Those that read files throw Error{resource} if the memory
// limit of `context.inputs` is exceeded.

/// Adds all materials to `scene.materials`, in their order, and their indices to `context.materials`. A
/// material with an error becomes black, so that references to it cause no second error. In addition to
/// errors of the models, reports:
/// - mixtures of mixtures or of materials with a medium inside, an axis or a relief, and weights above 1;
/// - a priority of a material without a medium inside, and a relief of a medium without a surface;
/// - images of reliefs that cannot be read, have other channels or normals that do not point outward.
void build_materials(const spec::Materials& materials, LoadContext& context, Scene& scene);
/// Builds the model of a material; nothing after an error, and for std::monostate. A mixture is still without
/// its components. Priority and relief are not built. Angles are converted to radians, lengths to metres.
[[nodiscard]] std::optional<MaterialModel> build_model(const spec::Material& material, LoadContext& context);
/// Index in `scene.materials` of the material of that name. Reports an unknown name with the nearest known
/// one, and returns nothing.
[[nodiscard]] std::optional<std::uint32_t> find_material(const schema::Located<std::string>& name,
                                                         LoadContext& context, const Scene& scene);
/// Index in `scene.materials` of a material of the mesh file `file`, added as "FILE:NAME" if it is new. It is
/// a clear dielectric or diffuse. One warning at `at` lists the features of a new material that are not
/// represented.
[[nodiscard]] std::uint32_t add_file_material(const FileMaterial& material, const std::string& file,
                                              const SourcePosition& at, LoadContext& context, Scene& scene);
/// Index in `scene.materials` of the black material of lights that name none, added at the first call.
[[nodiscard]] std::uint32_t black_material(LoadContext& context, Scene& scene);

/// Builds the medium inside a shape, with coefficients in 1/m (0 if absent) and without a grid. Warns of a
/// phase function without scattering. Returns nothing after an error of its curves.
[[nodiscard]] std::optional<Medium> build(const spec::Scattering& scattering,
                                          const std::optional<spec::Curve>& absorption, LoadContext& context);
/// Reads a grid of densities; positions in metres. Returns nothing after an error: a file that cannot be
/// read, other than 3 axes of 2 nodes or more, a density outside [0, 1e9], or an empty box.
[[nodiscard]] std::optional<PlacedGrid> build(const spec::Grid& grid, LoadContext& context);

}  // namespace abbe::description
