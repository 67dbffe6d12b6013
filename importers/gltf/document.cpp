#include "importers/gltf/document.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/meshes/gltf_file.h"
#include "description/meshes/mesh_formats.h"
#include "importers/shared/materials.h"
#include "io/json_values.h"
#include "materials/bsdf/principled.h"
#include "spectral/colorimetry.h"

namespace abbe::importers::gltf {

bool read_document(Document& document) {
  SceneImporter& importer = document.importer;
  const auto whole = std::make_shared<const SourceText>(SourceText{document.file.string(), ""});
  const SourcePosition where{whole, SourcePosition::kWholeFile, ""};
  std::string bytes;
  MemoryReservation reservation(importer.inputs, 0);
  if (const auto fault = read_mesh_bytes(document.file, bytes, reservation)) {
    importer.fail(where, *fault, ErrorCode::input);
    return false;
  }
  if (importer.inputs != nullptr) importer.inputs->add_file(document.file);
  const auto json = gltf_json(bytes);
  if (!json) {
    importer.fail(where, kBadGlb, ErrorCode::input);
    return false;
  }
  auto root =
      parse_json(std::make_shared<const SourceText>(SourceText{document.file.string(), std::string(*json)}),
                 importer.diagnostics, &document.memory);
  if (!root) return false;
  document.root = *std::move(root);
  return true;
}

const JsonValue* find(const JsonValue* object, std::string_view path) {
  while (object != nullptr && !path.empty()) {
    const std::size_t slash = path.find('/');
    object = object->find(path.substr(0, slash));
    path = slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
  }
  return object;
}

const JsonValue::Array& list(const JsonValue* object, std::string_view path) {
  static const JsonValue::Array kEmpty;
  const JsonValue* found = find(object, path);
  const auto* array = found ? std::get_if<JsonValue::Array>(&found->value) : nullptr;
  return array ? *array : kEmpty;
}

const JsonValue* element(const Document& document, std::string_view name, const JsonValue* index) {
  if (index == nullptr) return nullptr;
  const JsonValue::Array& all = list(&document.root, name);
  const auto* number = std::get_if<double>(&index->value);
  if (number && *number >= 0 && *number < static_cast<double>(all.size()))
    return &all[static_cast<std::size_t>(*number)];
  document.importer.fail(index->where, fmt::format("\"{}\" has no element with this index", name));
  return nullptr;
}

double number(const JsonValue* object, std::string_view path, double fallback, const Document& document) {
  const JsonValue* found = find(object, path);
  if (found == nullptr) return fallback;
  return read_number(*found, Range::any(), document.importer.diagnostics).value_or(fallback);
}

std::string text(const JsonValue* object, std::string_view path, const std::string& fallback) {
  const JsonValue* found = find(object, path);
  const auto* string = found ? std::get_if<std::string>(&found->value) : nullptr;
  return string ? *string : fallback;
}

std::optional<std::vector<double>> numbers(const JsonValue* object, std::string_view path, std::size_t count,
                                           const Document& document) {
  const JsonValue* found = find(object, path);
  if (found == nullptr) return std::nullopt;
  return read_numbers(*found, count, Range::any(), document.importer.diagnostics);
}

LinearRgb colour(const JsonValue* object, std::string_view path, const LinearRgb& fallback,
                 const Document& document) {
  const JsonValue* found = find(object, path);
  if (found == nullptr) return fallback;
  const auto values = read_numbers(*found, 0, Range::unit(), document.importer.diagnostics);
  if (!values) return fallback;
  if (values->size() == 3 || values->size() == 4) return {(*values)[0], (*values)[1], (*values)[2]};
  document.importer.fail(found->where,
                         fmt::format("a colour has three or four numbers (got {})", values->size()));
  return fallback;
}

namespace {

constexpr std::string_view kSurface = "pbrMetallicRoughness";
constexpr double kDefaultIndex = 1.5;

std::string extension(std::string_view name, std::string_view key) {
  return fmt::format("extensions/KHR_{}/{}", name, key);
}

// File name of a URI with its percent-encoding decoded (RFC 3986). A "%" without two hexadecimal digits is
// kept.
std::string file_of(std::string_view uri) {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const std::string_view digits = uri.substr(i + 1, 2);
    const char* end = digits.data() + digits.size();
    unsigned char byte = 0;
    if (uri[i] == '%' && digits.size() == 2 && std::from_chars(digits.data(), end, byte, 16).ptr == end) {
      name += static_cast<char>(byte);
      i += digits.size();
    } else {
      name += uri[i];
    }
  }
  return name;
}

// The image of a texture with its mapping. Nothing, after an error or a note, if it is not a file.
std::optional<spec::TextureFile> image(const JsonValue& info, const Document& document) {
  SceneImporter& importer = document.importer;
  const JsonValue* texture = element(document, "textures", find(&info, "index"));
  const JsonValue* source = element(document, "images", find(texture, "source"));
  const std::string uri = text(source, "uri", "");
  if (uri.empty() || uri.starts_with("data:")) {
    importer.note(info.where, "an image embedded in the file is not supported: dropped");
    return std::nullopt;
  }
  const auto path = document.file.parent_path() / file_of(uri);
  if (!importer.check_file(path, source->where)) return std::nullopt;
  const double coordinates = number(&info, "texCoord", 0, document);
  if (number(&info, extension("texture_transform", "texCoord"), coordinates, document) != 0)
    importer.note(info.where, "only the first set of texture coordinates is supported: it is used");
  spec::TextureFile file;
  file.image = {{importer.name_of(path)}, info.where};
  constexpr double kClamp = 33071;
  constexpr double kMirrored = 33648;
  constexpr double kNearest = 9728;
  const JsonValue* sampler = element(document, "samplers", find(texture, "sampler"));
  const double wrap_u = number(sampler, "wrapS", 0, document);
  const double wrap_v = number(sampler, "wrapT", 0, document);
  if (wrap_u == kClamp) file.mapping.wrap = TextureWrap::clamp;
  if (wrap_u == kMirrored || wrap_v == kMirrored) importer.note(info.where, kNoMirroredImages);
  if ((wrap_u == kClamp) != (wrap_v == kClamp))
    importer.note(info.where, "different wrap modes along u and v are not supported: that of u is used");
  if (number(sampler, "magFilter", 0, document) == kNearest) file.mapping.filter = TextureFilter::nearest;
  const auto scale = numbers(&info, extension("texture_transform", "scale"), 2, document);
  const auto offset = numbers(&info, extension("texture_transform", "offset"), 2, document);
  const Imath::V2d by = scale ? Imath::V2d((*scale)[0], (*scale)[1]) : Imath::V2d(1, 1);
  const Imath::V2d from = offset ? Imath::V2d((*offset)[0], (*offset)[1]) : Imath::V2d(0, 0);
  if (number(&info, extension("texture_transform", "rotation"), 0, document) != 0)
    importer.note(info.where, "rotation of an image on a surface is not supported: dropped");
  file.mapping.scale = by;
  file.mapping.offset = {from.x, 1 - by.y - from.y};  // v points down in glTF and up in Abbe.
  return file;
}

spec::Reflectance base_colour(const JsonValue* material, const SourcePosition& where,
                              const Document& document) {
  const JsonValue* surface = find(material, kSurface);
  const LinearRgb factor = colour(surface, "baseColorFactor", {1, 1, 1}, document);
  if (const JsonValue* texture = find(surface, "baseColorTexture")) {
    if (auto file = image(*texture, document)) {
      if (factor != LinearRgb{1, 1, 1})
        document.importer.note(texture->where, "a factor of an image is not supported: dropped");
      const auto path = document.importer.folder / file->image.value;
      if (const auto mean = colour_of_rejected_image(path, texture->where, document.importer))
        return curve_of(*mean, texture->where, document.importer);
      return spec::Texture{*std::move(file), spec::Rgb{{{true}, texture->where}}};
    }
  }
  return curve_of(factor, where, document.importer);
}

// Refractive index samples with the value n at the d line and the Abbe number 20/dispersion, by the formula
// of KHR_materials_dispersion.
spec::Ior dispersive_index(double n, double dispersion, const SourcePosition& where,
                           SceneImporter& importer) {
  Samples index;
  constexpr double kStep = 10;
  for (double nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; nm += kStep) {
    index.nm.push_back(nm);
    index.values.push_back(std::max(n + (n - 1) * dispersion / 20 * (523655 / (nm * nm) - 1.5168), 1.0));
  }
  return index_of(index, 0.0, where, importer);
}

// Absorption coefficient of the volume per unit of length: -ln(attenuationColor)/attenuationDistance. Nothing
// if it is colourless.
std::optional<LinearRgb> absorption_per_m(const JsonValue* material, const Document& document) {
  const LinearRgb transmitted =
      colour(material, extension("materials_volume", "attenuationColor"), {1, 1, 1}, document);
  const double distance = number(material, extension("materials_volume", "attenuationDistance"), 0, document);
  if (!(distance > 0) || transmitted == LinearRgb{1, 1, 1}) return std::nullopt;
  LinearRgb absorption{};
  constexpr double kBlack = 1e-6;  // No finite absorption turns white into 0.
  for (std::size_t i = 0; i < 3; ++i)
    absorption.at(i) = -std::log(std::max(transmitted.at(i), kBlack)) / distance;
  return absorption;
}

// Sets a transmitting material. The facet width alpha is the square of glTF's roughness.
void set_glass(const JsonValue* material, const SourcePosition& where, spec::Material& to,
               const Document& document) {
  SceneImporter& importer = document.importer;
  const double n = number(material, extension("materials_ior", "ior"), kDefaultIndex, document);
  const double dispersion = number(material, extension("materials_dispersion", "dispersion"), 0, document);
  const double roughness = number(find(material, kSurface), "roughnessFactor", 1, document);
  if (number(material, extension("materials_transmission", "transmissionFactor"), 0, document) != 1)
    importer.note(where, "partial transmission is not supported: the material transmits fully");
  if (colour(find(material, kSurface), "baseColorFactor", {1, 1, 1}, document) != LinearRgb{1, 1, 1})
    importer.note(where, "the base colour of a transmitting surface is not supported: dropped");
  spec::Ior index;
  index.value = n;
  index.where = where;
  if (!(number(material, extension("materials_volume", "thicknessFactor"), 0, document) > 0)) {
    spec::ThinGlass pane;
    pane.ior.ior = index;
    if (roughness != 0) importer.note(where, "roughness of thin glass is not supported: dropped");
    to.model = pane;
    return;
  }
  spec::Dielectric glass;
  glass.ior.ior = dispersion > 0 ? dispersive_index(n, dispersion, where, importer) : index;
  if (const auto absorption = absorption_per_m(material, document))
    glass.ior.absorption_per_m = curve_of(*absorption, where, importer);
  glass.roughness =
      roughness_of(roughness * roughness, roughness * roughness, FacetShape::ggx, where, importer);
  to.model = std::move(glass);
}

// Sets the clear coat. In glTF a coat of factor 1 has the full Fresnel reflectance of its index; in Abbe's
// principled model, a coat of weight 1 has the fraction `kCoatScale` of it. The width of the coat's facets is
// the square of glTF's roughness; gloss 0 has `kDullCoatAlpha`, gloss 1 `kGlossyCoatAlpha`.
void set_coat(const JsonValue* material, const SourcePosition& where, spec::Principled& surface,
              const Document& document) {
  const double factor = number(material, extension("materials_clearcoat", "clearcoatFactor"), 0, document);
  const double roughness =
      number(material, extension("materials_clearcoat", "clearcoatRoughnessFactor"), 0, document);
  if (factor == 0) return;
  const double width = roughness * roughness;
  const auto note_if_above = [&](const char* what, double value, double max_value) {
    if (value > max_value)
      document.importer.note(where, fmt::format("{} above {} is clamped to that value", what, max_value));
  };
  note_if_above("a clear coat factor", factor, kCoatScale);
  note_if_above("a facet width of a clear coat", width, kDullCoatAlpha);
  surface.clearcoat = std::min(factor / kCoatScale, 1.0);
  surface.clearcoat_gloss =
      std::clamp((kDullCoatAlpha - width) / (kDullCoatAlpha - kGlossyCoatAlpha), 0.0, 1.0);
}

// Sets a metallic-roughness surface. Abbe's `specular` is the reflectance ((n - 1)/(n + 1))^2 at normal
// incidence divided by 0.08.
void set_surface(const JsonValue* material, const SourcePosition& where, spec::Material& to,
                 const Document& document) {
  const double n = number(material, extension("materials_ior", "ior"), kDefaultIndex, document);
  const double r = (n - 1) / (n + 1);
  spec::Principled surface;
  surface.base_color = base_colour(material, where, document);
  surface.metallic = number(find(material, kSurface), "metallicFactor", 1, document);
  surface.roughness = number(find(material, kSurface), "roughnessFactor", 1, document);
  if (r * r > 0.08)
    document.importer.note(where, "a reflectance at normal incidence above 0.08 is clamped to that value");
  surface.specular = std::min(r * r / 0.08, 1.0);
  set_coat(material, where, surface, document);
  to.model = std::move(surface);
}

void note_unsupported_keys(const JsonValue* material, const SourcePosition& where, const Document& document) {
  SceneImporter& importer = document.importer;
  for (const std::string_view texture :
       {"pbrMetallicRoughness/metallicRoughnessTexture", "occlusionTexture", "emissiveTexture"})
    if (find(material, texture) != nullptr)
      importer.note(where,
                    fmt::format("{} is not supported: dropped", texture.substr(texture.rfind('/') + 1)));
  if (text(material, "alphaMode", "OPAQUE") != "OPAQUE")
    importer.note(where, "transparency masks are not supported: alpha is dropped");
  constexpr std::array<std::string_view, 6> kKnown{"KHR_materials_transmission",
                                                   "KHR_materials_ior",
                                                   "KHR_materials_volume",
                                                   "KHR_materials_dispersion",
                                                   "KHR_materials_emissive_strength",
                                                   "KHR_materials_clearcoat"};
  const JsonValue* extensions = find(material, "extensions");
  const auto* all = extensions ? std::get_if<JsonValue::Object>(&extensions->value) : nullptr;
  if (all == nullptr) return;
  for (const auto& [name, value] : *all) {
    if (std::ranges::find(kKnown, name) == kKnown.end())
      importer.note(value.where, fmt::format("{} is not supported: dropped", name));
    else if (const auto* keys = std::get_if<JsonValue::Object>(&value.value))
      for (const auto& [key, texture] : *keys)
        if (key.ends_with("Texture"))
          importer.note(texture.where, fmt::format("{} is not supported: dropped", key));
  }
}

}  // namespace

std::vector<std::string> material_names(const Document& document) {
  std::vector<std::string> names;
  for (const JsonValue& material : list(&document.root, "materials")) {
    const std::string name = text(&material, "name", "");
    names.push_back(name.empty() ? unnamed_gltf_material(names.size()) : name);
  }
  names.emplace_back(kDefaultGltfMaterial);
  return distinct_names(std::move(names));
}

spec::Material material_of(const JsonValue* material, const SourcePosition& where, const Document& document) {
  spec::Material result;
  if (number(material, extension("materials_transmission", "transmissionFactor"), 0, document) > 0)
    set_glass(material, where, result, document);
  else
    set_surface(material, where, result, document);
  if (const JsonValue* normals = find(material, "normalTexture")) {
    if (const auto file = image(*normals, document)) result.relief = spec::NormalMap{*file};
    if (number(normals, "scale", 1, document) != 1)
      document.importer.note(normals->where, "the scale of a normal map is not supported: dropped");
  }
  note_unsupported_keys(material, where, document);
  return result;
}

std::optional<spec::Emission> emission_of(const JsonValue* material, const Document& document) {
  const LinearRgb rgb = colour(material, "emissiveFactor", {0, 0, 0}, document);
  if (rgb == LinearRgb{0, 0, 0}) return std::nullopt;
  const double luminance =
      number(material, extension("materials_emissive_strength", "emissiveStrength"), 1, document);
  const ImportedLightSpectrum light =
      light_spectrum_of(rgb, luminance / kLuminousEfficacy, material->where, document.importer);
  return importers::emission_of<spec::Quantity::luminance>(light);
}

}  // namespace abbe::importers::gltf
