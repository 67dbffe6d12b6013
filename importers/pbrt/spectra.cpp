#include "importers/pbrt/spectra.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "importers/shared/materials.h"
#include "importers/shared/spectra.h"
#include "io/text.h"
#include "materials/index/library.h"

namespace abbe::importers::pbrt {
namespace {

/// A name of pbrt and the table of Abbe that replaces it.
struct Renamed {
  std::string_view source_name;  ///< Case-sensitive name in pbrt.
  std::string_view table_name;   ///< Name of a table that Abbe ships.
};

/// Metals, as tables of n and k. pbrt's names have the further ending "-eta" for n or "-k" for k.
constexpr std::array<Renamed, 6> kMetals{{{"metal-Ag", "Ag_Johnson"},
                                          {"metal-Al", "Al_Rakic"},
                                          {"metal-Au", "Au_Johnson"},
                                          {"metal-Cu", "Cu_Johnson"},
                                          {"metal-CuZn", "CuZn_Cu70Zn30_Querry"},
                                          {"metal-TiO2", "TiO2_Sarkar"}}};

/// Glasses. pbrt's tables for the last three are those of SF5, SF10 and SF11.
constexpr std::array<Renamed, 7> kGlasses{{{"glass-BK7", "N-BK7"},
                                           {"glass-BAF10", "N-BAF10"},
                                           {"glass-FK51A", "N-FK51A"},
                                           {"glass-LASF9", "schott/N-LASF9"},
                                           {"glass-F5", "schott/SF5"},
                                           {"glass-F10", "SF10"},
                                           {"glass-F11", "SF11"}}};

/// There is no shipped table of MgO: this is its index at the d line by the dispersion formula of
/// [Stephens1952], without absorption.
constexpr std::string_view kMagnesia = "metal-MgO";
constexpr double kMagnesiaIndex = 1.7375;

/// CIE illuminants, as relative spectra.
constexpr std::array<Renamed, 17> kIlluminants{{{"stdillum-A", "A"},
                                                {"stdillum-D50", "D50"},
                                                {"stdillum-D65", "D65"},
                                                {"stdillum-F1", "FL1"},
                                                {"stdillum-F2", "FL2"},
                                                {"stdillum-F3", "FL3"},
                                                {"stdillum-F4", "FL4"},
                                                {"stdillum-F5", "FL5"},
                                                {"stdillum-F6", "FL6"},
                                                {"stdillum-F7", "FL7"},
                                                {"stdillum-F8", "FL8"},
                                                {"stdillum-F9", "FL9"},
                                                {"stdillum-F10", "FL10"},
                                                {"stdillum-F11", "FL11"},
                                                {"stdillum-F12", "FL12"},
                                                {"illum-acesD60", "D60"},
                                                {"stdillum-D60", "D60"}}};

template <typename List>
std::optional<std::string> renamed(const List& list, std::string_view name) {
  const auto found = std::ranges::find(list, name, &Renamed::source_name);
  if (found == list.end()) return std::nullopt;
  return std::string(found->table_name);
}

template <typename List>
void add_names(const List& list, std::vector<std::string>& names) {
  for (const Renamed& entry : list) names.emplace_back(entry.source_name);
}

constexpr std::string_view kEta = "-eta";
constexpr std::string_view kK = "-k";
// Defaults of a conductor.
constexpr const char* kCopperEta = "metal-Cu-eta";
constexpr const char* kCopperK = "metal-Cu-k";

// "metal-Cu" for "metal-Cu-eta" and the suffix "-eta"; "" for names without the suffix.
std::string_view metal_of(std::string_view name, std::string_view end) {
  return name.ends_with(end) ? name.substr(0, name.size() - end.size()) : std::string_view();
}

void add_metal(std::string_view metal, std::vector<std::string>& names) {
  for (const std::string_view end : {kEta, kK}) names.push_back(fmt::format("{}{}", metal, end));
}

// Samples of n or k of a shipped table or formula, every 5 nm in the intersection of its range and the
// rendered range.
std::optional<Spectrum> index_samples(const std::string& material, bool extinction,
                                      const SourcePosition& where, ImportState& state) {
  constexpr double kStep = 5;
  const auto named = load_index(material, where, state.importer.diagnostics);
  if (!named) return std::nullopt;
  const RefractiveIndex& index = named->index;
  Samples samples;
  for (double nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; nm += kStep) {
    if (nm < index.low_nm() || nm > index.high_nm() || (extinction && !index.has_measured_k(nm))) continue;
    samples.nm.push_back(nm);
    samples.values.push_back(extinction ? index.k(nm) : index.n(nm));
  }
  return samples;
}

std::optional<Spectrum> file_or_name(const std::string& name, const SourcePosition& where,
                                     ImportState& state) {
  if (auto illuminant = renamed(kIlluminants, name)) return ShippedTable{*illuminant};
  const bool extinction = !metal_of(name, kK).empty();
  const std::string_view metal = metal_of(name, extinction ? kK : kEta);
  if (metal == kMagnesia) {
    state.importer.note(
        where, fmt::format("no table of MgO is shipped: {} is used at all wavelengths", kMagnesiaIndex));
    return extinction ? 0.0 : kMagnesiaIndex;
  }
  if (const auto shipped = renamed(kMetals, metal)) return index_samples(*shipped, extinction, where, state);
  if (const auto glass = renamed(kGlasses, name)) return index_samples(*glass, false, where, state);
  if (name.find('.') != std::string::npos) {
    return read_spectrum_file(state.folder / name, where, state.importer);
  }
  std::vector<std::string> names;
  add_names(kIlluminants, names);
  for (const Renamed& entry : kMetals) add_metal(entry.source_name, names);
  add_metal(kMagnesia, names);
  add_names(kGlasses, names);
  return state.importer.fail(where, unknown_name("spectrum", name, names));
}

std::optional<Spectrum> spectrum_of(const Parameter& parameter, ImportState& state) {
  if (parameter.type == "float") return parameter.numbers.front();
  if (parameter.type == "blackbody") return Temperature{parameter.numbers.front()};
  if (parameter.type == "rgb" || parameter.type == "color")
    return LinearRgb{parameter.numbers[0], parameter.numbers[1], parameter.numbers[2]};
  if (!parameter.texts.empty()) return file_or_name(parameter.texts.front(), parameter.where, state);
  if (parameter.numbers.size() % 2 != 0)
    return state.importer.fail(parameter.where,
                               fmt::format("\"{}\" takes pairs of wavelength and value (got {} numbers)",
                                           parameter.name, parameter.numbers.size()));
  return samples_of_pairs(parameter.numbers, parameter.where, state.importer);
}

// The texture of that kind and name; an unknown one is reported.
const TextureValue* find_texture(TextureKind kind, const std::string& name, const SourcePosition& where,
                                 ImportState& state) {
  const char* what = kind == TextureKind::number ? "float texture" : "spectrum texture";
  return find(state.textures[kind], what, name, where, state.importer);
}

// The spectrum of a parameter, or the texture that it names.
TextureValue texture(const Parameters& parameters, std::string_view name, const Spectrum& fallback,
                     TextureKind kind, ImportState& state) {
  const Parameter* found =
      parameters.find(name, {"float", "rgb", "color", "blackbody", "spectrum", "texture"});
  if (found == nullptr) return fallback;
  if (found->type != "texture") return spectrum_of(*found, state).value_or(fallback);
  const TextureValue* known = find_texture(kind, found->texts.front(), found->where, state);
  return known ? *known : TextureValue(fallback);
}

// The image file of an "imagemap" texture with its mapping. Nothing after an error.
std::optional<spec::TextureFile> image_file(const Parameters& parameters, const SourcePosition& where,
                                            ImportState& state) {
  SceneImporter& importer = state.importer;
  const Parameter* name = parameters.find("filename", {"string"});
  if (name == nullptr) return importer.fail(where, "an image needs \"filename\"");
  const auto path = state.folder / name->texts.front();
  if (!importer.check_file(path, name->where)) return std::nullopt;
  spec::TextureFile file;
  file.image = {{importer.name_of(path)}, name->where};
  file.mapping.scale = {parameters.number("uscale", 1), parameters.number("vscale", 1)};
  file.mapping.offset = {parameters.number("udelta", 0), parameters.number("vdelta", 0)};
  const std::string wrap = parameters.text("wrap", "repeat");
  importer.is_known("wrap mode", wrap, {"black", "clamp", "octahedralsphere", "repeat"}, where);
  if (wrap != "repeat") file.mapping.wrap = TextureWrap::clamp;
  if (wrap == "black" || wrap == "octahedralsphere")
    importer.note(
        where, fmt::format("the wrap mode \"{}\" is not supported: the image is clamped at its edges", wrap));
  if (parameters.text("filter", "bilinear") == "point") file.mapping.filter = TextureFilter::nearest;
  return file;
}

TextureValue scaled_texture(const Directive& directive, TextureKind kind, ImportState& state) {
  TextureValue value = texture(directive.parameters, "tex", 1.0, kind, state);
  const double factor = number(directive.parameters, "scale", 1, state);
  if (auto* spectrum = std::get_if<Spectrum>(&value)) return scaled(*spectrum, factor);
  if (factor != 1) directive.note("a scale of an image is not supported: dropped");
  return value;
}

}  // namespace

TextureValue texture_of(const Directive& directive, TextureKind kind, ImportState& state) {
  if (directive.type == "constant") return texture(directive.parameters, "value", 1.0, kind, state);
  if (directive.type == "scale") return scaled_texture(directive, kind, state);
  if (directive.type == "imagemap") {
    const auto file = image_file(directive.parameters, directive.where, state);
    if (!file) return Spectrum(0.5);
    const std::string encoding = directive.parameters.text("encoding", "sRGB");
    if (encoding != "linear" && encoding != "sRGB")
      directive.note("a gamma encoding of an image is not supported: sRGB is used");
    return colours_of(*file, encoding == "linear", directive.where, state.importer);
  }
  directive.note(fmt::format("a texture \"{}\" is not supported: replaced by a constant", directive.type));
  for (const std::string_view first : {"tex1", "inside", "value"})
    if (directive.parameters.has(first)) return texture(directive.parameters, first, 0.5, kind, state);
  return Spectrum(0.5);
}

Spectrum spectrum(const Parameters& parameters, std::string_view name, const Spectrum& fallback,
                  ImportState& state) {
  const Parameter* found = parameters.find(name, {"float", "rgb", "color", "blackbody", "spectrum"});
  return found ? spectrum_of(*found, state).value_or(fallback) : fallback;
}

spec::Reflectance reflectance(const Parameters& parameters, std::string_view name, double fallback,
                              ImportState& state) {
  const Parameter* found = parameters.find(name, {"float", "rgb", "color", "spectrum", "texture"});
  TextureValue value = texture(parameters, name, fallback, TextureKind::spectrum, state);
  if (auto* image = std::get_if<spec::Texture>(&value)) return *image;
  return curve_of(std::get<Spectrum>(value), found ? found->where : SourcePosition{}, state.importer);
}

double number(const Parameters& parameters, std::string_view name, double fallback, ImportState& state) {
  const TextureValue value = texture(parameters, name, fallback, TextureKind::number, state);
  if (const auto* spectrum = std::get_if<Spectrum>(&value)) return number_of(*spectrum).value_or(fallback);
  const Parameter* found = parameters.find(name, {"texture"});
  state.importer.note(found->where,
                      fmt::format("an image as \"{}\" is not supported: {} is used", name, fallback));
  return fallback;
}

std::optional<spec::TextureFile> image(const std::string& name, const SourcePosition& where,
                                       ImportState& state) {
  const TextureValue* known = find_texture(TextureKind::number, name, where, state);
  if (known == nullptr) return std::nullopt;
  if (const auto* texture = std::get_if<spec::Texture>(known)) {
    if (holds_codes(texture->file.image.value) && std::holds_alternative<spec::Rgb>(texture->of))
      state.importer.note(where, kLinearRelief);
    return texture->file;
  }
  state.importer.note(where, fmt::format("the texture \"{}\" is not an image: dropped", name));
  return std::nullopt;
}

spec::Ior metal_index(const Parameters& parameters, std::string_view eta, std::string_view k,
                      ImportState& state) {
  static constexpr std::initializer_list<const char*> kTypes{"spectrum", "rgb", "float"};
  const Parameter* n = parameters.find(eta, kTypes);
  const Parameter* extinction = parameters.find(k, kTypes);
  const auto name_of = [](const Parameter* parameter, const char* fallback) {
    if (parameter == nullptr) return std::string(fallback);
    return parameter->texts.empty() ? std::string() : parameter->texts.front();
  };
  const std::string n_name = name_of(n, kCopperEta);
  const std::string k_name = name_of(extinction, kCopperK);
  spec::Ior ior;
  if (n != nullptr || extinction != nullptr) ior.where = n != nullptr ? n->where : extinction->where;
  const auto metal = renamed(kMetals, metal_of(n_name, kEta));
  if (metal && metal_of(n_name, kEta) == metal_of(k_name, kK)) {
    ior.value = *metal;
    return ior;
  }
  const auto spectrum_or_copper = [&](const Parameter* parameter, const char* copper) {
    return (parameter ? spectrum_of(*parameter, state) : file_or_name(copper, ior.where, state))
        .value_or(1.0);
  };
  return index_of(spectrum_or_copper(n, kCopperEta), spectrum_or_copper(extinction, kCopperK), ior.where,
                  state.importer);
}

spec::Ior glass_index(const Parameters& parameters, ImportState& state) {
  const Parameter* n = parameters.find("eta", {"spectrum", "float", "rgb", "texture"});
  spec::Ior ior;
  ior.value = 1.5;
  if (n == nullptr) return ior;
  const Spectrum value = spectrum(parameters, "eta", 1.5, state);
  ior = index_of(value, 0.0, n->where, state.importer);
  if (const auto* constant = std::get_if<spec::MetalIor>(&ior.value)) ior.value = double{constant->n};
  return ior;
}

}  // namespace abbe::importers::pbrt
