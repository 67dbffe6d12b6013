#include "description/material.h"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "io/npy.h"

namespace abbe::description {
namespace {

constexpr char kBlack[] = "black (light)";

PhaseFunction build_phase(const spec::Scattering& spec) {
  if (!spec.phase) return IsotropicPhase{};
  if (const auto* peak = std::get_if<spec::HenyeyGreenstein>(&spec.phase->value))
    return HenyeyGreensteinPhase{static_cast<float>(peak->g)};
  if (std::get<spec::PhaseWord>(spec.phase->value) == spec::PhaseWord::isotropic) return IsotropicPhase{};
  return RayleighPhase{};
}

// Builds a coefficient [1/m]; 0 if the key is absent.
std::optional<Curve> build_coefficient(const std::optional<spec::Curve>& spec, LoadContext& context) {
  if (!spec) return Curve(0.0);
  return build(*spec, {"filter", spec::kPower, CurveUnit::per_metre}, context);
}

std::optional<DensityGrid> build_densities(const schema::Located<std::string>& spec, LoadContext& context) {
  const SourcePosition& where = spec.where;
  const auto path = context.file(spec.value, where);
  if (!path) return std::nullopt;
  NumberArray array;
  try {
    array = read_npy(*path, context.inputs);
  } catch (const Error& e) {
    return context.refuse(where, e.what(), e.code);
  }
  const auto fault = [&](std::string_view what) {
    return context.refuse(where, fmt::format("\"{}\" {}", spec.value, what), ErrorCode::input);
  };
  if (array.shape.size() != 3)
    return fault(fmt::format("has {} axes, allowed 3: z, y, x", array.shape.size()));
  for (const std::size_t nodes : array.shape)
    if (nodes < 2) return fault("has an axis of fewer than 2 nodes");
  for (const float density : array.values)
    if (!(density >= 0 && density <= 1e9F)) return fault("has a density that is not in [0, 1e9]");
  const auto& n = array.shape;
  return DensityGrid{{static_cast<int>(n[2]), static_cast<int>(n[1]), static_cast<int>(n[0])},
                     std::move(array.values)};
}

constexpr double kSlack = 1e-9;  // Thirds written with ten digits may add up to slightly more than 1.

// Material of that name, if it can be a component of a mixture; else reports why not and returns nullptr.
std::shared_ptr<const Material> mixable_material(const schema::Located<std::string>& name,
                                                 LoadContext& context, const Scene& scene) {
  const auto number = find_material(name, context, scene);
  if (!number) return nullptr;
  const Material& material = scene.materials[*number];
  const char* fault = nullptr;
  if (std::holds_alternative<MixtureMaterial>(material.model)) fault = "a mixture within a mixture";
  if (interior_index(material) != nullptr || medium(material) != nullptr)
    fault = "it has a medium inside, which a mixture cannot have";
  const auto delta_lobe = smooth_mueller(material, {550, 1, false});
  if (delta_lobe && delta_lobe->axis)
    fault = "its axis would be lost, because a mixture has one axis for all components";
  if (material.relief != nullptr) fault = "its relief would be lost; give the relief to the mixture";
  if (fault == nullptr) return std::make_shared<const Material>(material);
  context.diagnostics.error(name.where,
                            fmt::format("material \"{}\" cannot be mixed: {}", material.name, fault));
  return nullptr;
}

std::optional<MixtureMaterial> build(const spec::Mixture& spec, LoadContext& context, const Scene& scene) {
  MixtureMaterial mixture;
  Curve total(0.0);
  for (const spec::MixturePart& part : spec.value) {
    auto weight = build(part.weight, kReflectanceUse, context);
    auto material = mixable_material(part.material, context, scene);
    if (!weight || !material) return std::nullopt;
    total = sum(total, *weight);
    mixture.components.push_back({std::move(*weight), std::move(material)});
  }
  if (total.max() <= 1 + kSlack) return mixture;
  return context.refuse(
      spec.where, fmt::format("the weights of a mixture must add up to at most 1 (got {:g})", total.max()));
}

// The image of a map. Reports an image with another number of channels than the map needs.
std::optional<TextureImage> map_image(const TextureFile& file, std::span<const std::string> channels,
                                      const char* what, LoadContext& context) {
  if (file.image.channels.size() != channels.size()) {
    file.refuse(
        fmt::format("{} needs {} (got {} channels)", what,
                    channels.size() == 1 ? "one channel" : "channels R, G, B", file.image.channels.size()),
        ErrorCode::input, context);
    return std::nullopt;
  }
  auto texels = read_texels(file, channels, kLinearEncoding, context);
  if (!texels) return std::nullopt;
  return texture_image(file, channels.size(), std::move(*texels));
}

// Reason why texel number `i` is not an outward normal, if it is not.
std::optional<std::string> normal_fault(const TextureFile& file, const std::vector<const ImageChannel*>& rgb,
                                        std::size_t i) {
  constexpr float kRounding = 1e-3F;  // Rounding of filtered values and of half floats.
  for (const ImageChannel* channel : rgb)
    if (const float value = channel->values[i]; value < -kRounding || value > 1 + kRounding)
      return fmt::format("{} is not an encoded normal (got {} = {}, allowed [0, 1])", file.texel_name(i),
                         channel->name, value);
  const float outward = rgb.back()->values[i];
  if (outward > 0.5F) return std::nullopt;
  return fmt::format("{} is a normal that does not point outward (got B = {}, allowed (0.5, 1])",
                     file.texel_name(i), outward);
}

std::shared_ptr<const Relief> build(std::monostate, LoadContext&) {
  return nullptr;
}

std::shared_ptr<const Relief> build(const spec::NormalMap& spec, LoadContext& context) {
  const auto file = build(spec.file, context);
  if (!file) return nullptr;
  const std::vector<std::string> channels{"R", "G", "B"};
  auto image = map_image(*file, channels, "a normal map", context);
  if (!image) return nullptr;
  std::vector<const ImageChannel*> rgb;
  for (const std::string& channel : channels) rgb.push_back(file->image.find(channel));
  for (std::size_t i = 0; i < file->image.pixels(); ++i) {
    const auto fault = normal_fault(*file, rgb, i);
    if (!fault) continue;
    file->refuse(*fault, ErrorCode::input, context);
    return nullptr;
  }
  return std::make_shared<const Relief>(NormalMap{std::move(*image)});
}

std::shared_ptr<const Relief> build(const spec::BumpMap& spec, LoadContext& context) {
  const auto file = build(spec.file, context);
  if (!file) return nullptr;
  const std::vector<std::string> only{file->image.channels.empty() ? "" : file->image.channels[0].name};
  auto image = map_image(*file, only, "a bump map", context);
  if (!image) return nullptr;
  return std::make_shared<const Relief>(BumpMap{std::move(*image), spec.height * context.unit_m});
}

// Builds a material. One with an error becomes black.
Material build_material(const schema::Named<spec::Material>& spec, LoadContext& context) {
  Material material{spec.name, DiffuseMaterial{Curve(0.0)}};
  if (auto model = build_model(spec.value, context)) material.model = *std::move(model);
  if (const auto& priority = spec.value.priority) {
    if (!encloses_medium(material))
      context.diagnostics.error(priority->where,
                                "priority applies only to a medium inside a shape: a dielectric or a medium");
    material.priority = priority->value;
  }
  material.relief = std::visit([&](const auto& relief) { return build(relief, context); }, spec.value.relief);
  if (material.relief && is_boundary(material))
    context.diagnostics.error(spec.where, "a medium has no surface and cannot have a normal_map or bump_map");
  return material;
}

}  // namespace

void build_materials(const spec::Materials& materials, LoadContext& context, Scene& scene) {
  for (const auto& spec : materials) {
    context.materials.emplace(spec.name, static_cast<std::uint32_t>(scene.materials.size()));
    scene.materials.push_back(build_material(spec, context));
  }
  // Mixtures refer to the other materials and are built after them.
  for (const auto& [name, material, where] : materials) {
    const auto* mixture_spec = std::get_if<spec::Mixture>(&material.model);
    if (mixture_spec == nullptr) continue;
    if (auto mixture = build(*mixture_spec, context, scene))
      scene.materials[context.materials.at(name)].model = std::move(*mixture);
  }
}

std::optional<std::uint32_t> find_material(const schema::Located<std::string>& name, LoadContext& context,
                                           const Scene& scene) {
  if (const auto found = context.materials.find(name.value); found != context.materials.end())
    return found->second;
  std::vector<std::string> names;
  for (const Material& material : scene.materials) names.push_back(material.name);
  return context.refuse(name.where, unknown_name("material", name.value, names));
}

std::uint32_t add_file_material(const FileMaterial& material, const std::string& file,
                                const SourcePosition& at, LoadContext& context, Scene& scene) {
  const std::string name = file + ":" + material.name;
  const auto [known, added] =
      context.materials.emplace(name, static_cast<std::uint32_t>(scene.materials.size()));
  if (!added) return known->second;
  if (material.index)
    scene.materials.push_back(
        {name, DielectricMaterial{fmt::format("{}", *material.index), RefractiveIndex(*material.index, 0)}});
  else
    scene.materials.push_back({name, DiffuseMaterial{rgb_spectrum(material.color)}});
  if (!material.ignored.empty())
    context.diagnostics.warning(
        at, fmt::format("material \"{}\" of \"{}\": {} {} not represented", material.name, file,
                        fmt::join(material.ignored, ", "), material.ignored.size() == 1 ? "is" : "are"));
  return known->second;
}

std::uint32_t black_material(LoadContext& context, Scene& scene) {
  const auto [known, added] =
      context.materials.emplace(kBlack, static_cast<std::uint32_t>(scene.materials.size()));
  if (added) scene.materials.push_back({kBlack, DiffuseMaterial{Curve(0.0)}});
  return known->second;
}

std::optional<PlacedGrid> build(const spec::Grid& spec, LoadContext& context) {
  const Imath::V3d from = spec.from * context.unit_m;
  const Imath::V3d to = spec.to * context.unit_m;
  if (!(to.x > from.x && to.y > from.y && to.z > from.z))
    return context.refuse(spec.where, "the grid's `to` must be greater than its `from` along x, y and z");
  auto grid = build_densities(spec.densities, context);
  if (!grid) return std::nullopt;
  return PlacedGrid{std::make_shared<const DensityGrid>(std::move(*grid)), from, to};
}

std::optional<Medium> build(const spec::Scattering& spec, const std::optional<spec::Curve>& absorption,
                            LoadContext& context) {
  auto scatters = build_coefficient(spec.per_m, context);
  auto absorbs = build_coefficient(absorption, context);
  if (spec.phase && !spec.per_m)
    context.diagnostics.warning(spec.phase->where, "phase has no effect without scattering_per_m");
  if (!scatters || !absorbs) return std::nullopt;
  return Medium{std::move(*absorbs), std::move(*scatters), build_phase(spec)};
}

}  // namespace abbe::description
