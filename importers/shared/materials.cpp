#include "importers/shared/materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "io/picture.h"
#include "io/schema/read.h"
#include "io/text.h"

namespace abbe::importers {
namespace {

template <typename Scene>
auto* find_material(const std::string& name, Scene& scene) {
  const auto found = std::ranges::find(scene.materials, name, &schema::Named<spec::Material>::name);
  return found == scene.materials.end() ? nullptr : &found->value;
}

// Calls `with` with the model's property that may be an image, if there is one.
template <typename Model, typename With>
void with_reflectance(Model& model, With with) {
  if constexpr (requires { model.reflectance; })
    with(model.reflectance);
  else if constexpr (requires { model.base_color; })
    with(model.base_color);
}

// Mean of the decoded values. Nothing if a value is not finite.
std::optional<double> mean(const ImageChannel& channel, const Encoding& encoding) {
  double sum = 0;
  for (const float value : channel.values) {
    if (!std::isfinite(value)) return std::nullopt;
    sum += encoding.decoded(std::max(static_cast<double>(value), 0.0));
  }
  return sum / static_cast<double>(channel.values.size());
}

std::optional<LinearRgb> mean_of(const Image& image, const Encoding& encoding, const SourcePosition& where,
                                 SceneImporter& importer) {
  constexpr std::array<std::string_view, 3> kNames{"R", "G", "B"};
  const auto refuse = [&](const std::string& what) { return importer.fail(where, what, ErrorCode::input); };
  LinearRgb colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    const ImageChannel* channel = image.find(image.find("R") ? kNames.at(c) : "Y");
    if (channel == nullptr) return refuse("the image has no channels R, G, B or Y");
    const auto value = mean(*channel, encoding);
    if (!value) return refuse("the image has values that are not finite");
    colour.at(c) = *value;
  }
  return colour;
}

}  // namespace

std::optional<spec::Roughness> roughness_of(double along, double across, FacetShape distribution,
                                            const SourcePosition& where, SceneImporter& importer) {
  const double u = std::clamp(along, 0.0, 1.0);
  const double v = std::clamp(across, 0.0, 1.0);
  if (u != along || v != across) importer.note(where, "a facet width outside [0, 1] is clamped");
  if (u == 0 && v == 0) return std::nullopt;
  spec::Roughness roughness;
  roughness.where = where;
  const spec::Alpha alpha = u == v ? spec::Alpha(u) : spec::Alpha(std::array{u, v});
  if (distribution != FacetShape::ggx)
    roughness.value = spec::Facets{alpha, distribution};
  else if (u == v)
    roughness.value = u;
  else
    roughness.value = std::array{u, v};
  return roughness;
}

spec::Ior index_of_reflectance(const Spectrum& reflectance, const SourcePosition& where,
                               SceneImporter& importer) {
  const auto k_of = [](double r) {
    const double clamped = std::clamp(r, 0.0, 0.9996);  // Reflectance for k = 100, the largest allowed.
    return 2 * std::sqrt(clamped / (1 - clamped));
  };
  importer.note(where,
                "a colour does not determine the index of a metal: n = 1 with k for this reflectance at "
                "normal incidence is used");
  const auto* rgb = std::get_if<LinearRgb>(&reflectance);
  const auto* samples = std::get_if<Samples>(&reflectance);
  if (rgb != nullptr || samples != nullptr) {
    return index_of(1.0, extend_constant(mapped(rgb ? samples_of(*rgb) : *samples, k_of), k_of(0)), where,
                    importer);
  }
  const auto* number = std::get_if<double>(&reflectance);
  return index_of(1.0, number ? Spectrum(k_of(*number)) : reflectance, where, importer);
}

bool is_textured(const std::string& name, const SceneImporter& importer) {
  const spec::Material* material = find_material(name, importer.scene);
  if (material == nullptr) return false;
  bool textured = !std::holds_alternative<std::monostate>(material->relief);
  const auto check = [&textured](const spec::Reflectance& reflectance) {
    textured = textured || std::holds_alternative<spec::Texture>(reflectance);
  };
  std::visit([&](const auto& model) { with_reflectance(model, check); }, material->model);
  if (const auto* mixture = std::get_if<spec::Mixture>(&material->model))
    for (const spec::MixturePart& part : mixture->value)
      textured = textured || is_textured(part.material.value, importer);
  return textured;
}

bool fills_interior(const std::string& name, const SceneImporter& importer) {
  const spec::Material* material = find_material(name, importer.scene);
  return material != nullptr && (std::holds_alternative<spec::Dielectric>(material->model) ||
                                 std::holds_alternative<spec::Medium>(material->model));
}

std::string without_images(const std::string& name, SceneImporter& importer) {
  std::string plain = name + " without images";
  const spec::Material* given = find_material(name, importer.scene);
  if (given == nullptr || find_material(plain, importer.scene) != nullptr) return plain;
  spec::Material material = *given;
  material.relief = std::monostate{};
  const auto clear = [](spec::Reflectance& reflectance) {
    if (!std::holds_alternative<spec::Texture>(reflectance)) return;
    spec::Curve grey;
    grey.value = 0.5;
    reflectance = grey;
  };
  std::visit([&](auto& model) { with_reflectance(model, clear); }, material.model);
  if (auto* mixture = std::get_if<spec::Mixture>(&material.model))
    for (spec::MixturePart& part : mixture->value)
      if (is_textured(part.material.value, importer))
        part.material.value = without_images(part.material.value, importer);
  return importer.add_material(plain, std::move(material));
}

void replace_materials(const std::filesystem::path& map, SceneImporter& importer) {
  const auto source = importer.read(map);
  if (!source) return;
  MemoryReservation tree(importer.inputs, 0);
  const auto json = parse_json(source, importer.diagnostics, &tree);
  if (!json) return;
  const auto chosen = schema::read<spec::Materials>(*json, spec::materials(), importer.diagnostics);
  if (!chosen) return;
  std::vector<std::string> names;
  for (const auto& material : importer.scene.materials) names.push_back(material.name);
  for (const auto& material : *chosen) {
    spec::Material* replaced = find_material(material.name, importer.scene);
    if (replaced == nullptr)
      importer.fail(material.where, unknown_name("material", material.name, names));
    else
      *replaced = material.value;
  }
}

bool holds_codes(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 3> kOfFloats{".exr", ".hdr", ".pfm"};
  return std::ranges::find(kOfFloats, extension_of(file)) == kOfFloats.end();
}

std::optional<LinearRgb> colour_of_rejected_image(const std::filesystem::path& file,
                                                  const SourcePosition& where, SceneImporter& importer) {
  try {
    const Image image = read_image(file, importer.inputs);
    const MemoryReservation reservation(importer.inputs, image.memory_bytes());
    if (const auto fault = rec709_fault(image)) {
      importer.note(where,
                    "an image that Abbe rejects is replaced by its mean as sRGB, as which the source "
                    "renderer takes all images: " +
                        *fault);
      return mean_of(image, Encoding{}, where, importer);
    }
    if (recorded_encoding(image).value_or(Encoding{}).gamma)
      importer.note(where, "an image is decoded as it declares: the source renderer takes it as sRGB");
  } catch (const Error& fault) {
    importer.fail(where, fault.what(), fault.code);
  }
  return std::nullopt;
}

std::optional<LinearRgb> mean_colour(const std::filesystem::path& file, const SourcePosition& where,
                                     SceneImporter& importer) {
  if (!importer.check_file(file, where)) return std::nullopt;
  try {
    const Image image = read_image(file, importer.inputs);
    if (const auto fault = rec709_fault(image)) return importer.fail(where, *fault, ErrorCode::input);
    return mean_of(image, recorded_encoding(image).value_or(Encoding{}), where, importer);
  } catch (const Error& fault) {
    return importer.fail(where, fault.what(), fault.code);
  }
}

}  // namespace abbe::importers
