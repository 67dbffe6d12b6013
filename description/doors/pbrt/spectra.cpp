#include "description/doors/pbrt/spectra.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "description/doors/pbrt/named_spectra.h"
#include "description/doors/shared/picture.h"
#include "description/doors/shared/spectrum_file.h"
#include "io/text.h"
#include "materials/index/library.h"

namespace abbe::doors::pbrt {
namespace {

template <typename List>
std::optional<std::string> renamed(const List& list, std::string_view name) {
  const auto found = std::ranges::find(list, name, &Renamed::theirs);
  if (found == list.end()) return std::nullopt;
  return std::string(found->ours);
}

template <typename List>
void add_names(const List& list, std::vector<std::string>& names) {
  for (const Renamed& entry : list) names.emplace_back(entry.theirs);
}

constexpr std::string_view kEta = "-eta";
constexpr std::string_view kK = "-k";
// What a conductor has where it does not say.
constexpr const char* kCopperEta = "metal-Cu-eta";
constexpr const char* kCopperK = "metal-Cu-k";

// "metal-Cu" of "metal-Cu-eta", where it ends so; "" of other names.
std::string_view metal_of(std::string_view name, std::string_view end) {
  return name.ends_with(end) ? name.substr(0, name.size() - end.size()) : std::string_view();
}

void add_metal(std::string_view metal, std::vector<std::string>& names) {
  for (const std::string_view end : {kEta, kK}) names.push_back(fmt::format("{}{}", metal, end));
}

// n or k of a shipped table or formula, every 5 nm where it is measured and the renderer has wavelengths.
std::optional<Spectrum> index_samples(const std::string& material, bool extinction,
                                      const SourcePosition& where, World& world) {
  constexpr double kStep = 5;
  const auto named = load_index(material, where, world.door.diagnostics);
  if (!named) return std::nullopt;
  const RefractiveIndex& index = named->index;
  Samples samples;
  for (double nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; nm += kStep) {
    if (nm < index.low_nm() || nm > index.high_nm() || (extinction && !index.knows_k(nm))) continue;
    samples.nm.push_back(nm);
    samples.values.push_back(extinction ? index.k(nm) : index.n(nm));
  }
  return samples;
}

std::optional<Spectrum> file_or_name(const std::string& name, const SourcePosition& where, World& world) {
  if (auto illuminant = renamed(kIlluminants, name)) return Shipped{*illuminant};
  const bool extinction = !metal_of(name, kK).empty();
  const std::string_view metal = metal_of(name, extinction ? kK : kEta);
  if (metal == kMagnesia) {
    world.door.note(
        where, fmt::format("no table of MgO is shipped: the number {} at all wavelengths", kMagnesiaIndex));
    return extinction ? 0.0 : kMagnesiaIndex;
  }
  if (const auto shipped = renamed(kMetals, metal)) return index_samples(*shipped, extinction, where, world);
  if (const auto glass = renamed(kGlasses, name)) return index_samples(*glass, false, where, world);
  if (name.find('.') != std::string::npos) {
    auto samples = read_spectrum_file(world.folder / name, where, world.door);
    if (!samples) return std::nullopt;
    samples->outside = Outside::zero;
    return *samples;
  }
  std::vector<std::string> names;
  add_names(kIlluminants, names);
  for (const Renamed& entry : kMetals) add_metal(entry.theirs, names);
  add_metal(kMagnesia, names);
  add_names(kGlasses, names);
  world.door.diagnostics.error(where, unknown_name("spectrum", name, names));
  return std::nullopt;
}

std::optional<Spectrum> spectrum_of(const Parameter& parameter, World& world) {
  if (parameter.type == "float") return parameter.numbers.front();
  if (parameter.type == "blackbody") return Temperature{parameter.numbers.front()};
  if (parameter.type == "rgb" || parameter.type == "color")
    return LinearRgb{parameter.numbers[0], parameter.numbers[1], parameter.numbers[2]};
  if (!parameter.texts.empty()) return file_or_name(parameter.texts.front(), parameter.where, world);
  Samples samples{{}, {}, Outside::zero};
  for (std::size_t i = 0; i + 1 < parameter.numbers.size(); i += 2) {
    samples.nm.push_back(parameter.numbers[i]);
    samples.values.push_back(parameter.numbers[i + 1]);
  }
  if (parameter.numbers.size() % 2 != 0) {
    world.door.diagnostics.error(parameter.where,
                                 fmt::format("\"{}\" takes pairs of wavelength and value (got "
                                             "{} numbers)",
                                             parameter.name, parameter.numbers.size()));
    return std::nullopt;
  }
  if (!check_samples(samples, parameter.where, world.door)) return std::nullopt;
  return samples;
}

// The texture of that kind and name; an unknown one is reported.
const TextureValue* find_texture(TextureKind kind, const std::string& name, const SourcePosition& where,
                                 World& world) {
  const char* what = kind == TextureKind::number ? "float texture" : "spectrum texture";
  return find(world.textures[kind], what, name, where, world.door);
}

// A texture times a factor.
TextureValue scaled_texture(const Made& made, TextureKind kind, World& world) {
  TextureValue value = texture(made.parameters, "tex", 1.0, kind, world);
  const double factor = number(made.parameters, "scale", 1, world);
  if (auto* spectrum = std::get_if<Spectrum>(&value)) return scaled(*spectrum, factor);
  if (factor != 1) world.door.note(made.where, "an image's scale has no counterpart here: dropped");
  return value;
}

}  // namespace

TextureValue texture_of(const Made& made, TextureKind kind, World& world) {
  if (made.type == "constant") return texture(made.parameters, "value", 1.0, kind, world);
  if (made.type == "scale") return scaled_texture(made, kind, world);
  if (made.type == "imagemap") {
    const auto file = image_file(made.parameters, made.where, world);
    if (!file) return Spectrum(0.5);
    const std::string encoding = made.parameters.text("encoding", "sRGB", world.door);
    if (encoding != "linear" && encoding != "sRGB")
      world.door.note(made.where, "an image's encoding by a power has no counterpart here: sRGB");
    return colours_of(*file, encoding == "linear", made.where, world.door);
  }
  world.door.note(made.where,
                  fmt::format("a texture \"{}\" has no counterpart here: one value in its place", made.type));
  for (const std::string_view first : {"tex1", "inside", "value"})
    if (made.parameters.has(first)) return texture(made.parameters, first, 0.5, kind, world);
  return Spectrum(0.5);
}

Spectrum spectrum(const Parameters& parameters, std::string_view name, const Spectrum& absent, World& world) {
  const Parameter* found =
      parameters.find(name, {"float", "rgb", "color", "blackbody", "spectrum"}, world.door);
  return found ? spectrum_of(*found, world).value_or(absent) : absent;
}

TextureValue texture(const Parameters& parameters, std::string_view name, const Spectrum& absent,
                     TextureKind kind, World& world) {
  const Parameter* found =
      parameters.find(name, {"float", "rgb", "color", "blackbody", "spectrum", "texture"}, world.door);
  if (found == nullptr) return absent;
  if (found->type != "texture") return spectrum_of(*found, world).value_or(absent);
  const TextureValue* known = find_texture(kind, found->texts.front(), found->where, world);
  return known ? *known : TextureValue(absent);
}

spec::Reflectance reflectance(const Parameters& parameters, std::string_view name, double absent,
                              World& world) {
  const Parameter* found =
      parameters.find(name, {"float", "rgb", "color", "spectrum", "texture"}, world.door);
  TextureValue value = texture(parameters, name, absent, TextureKind::spectrum, world);
  if (auto* image = std::get_if<spec::Texture>(&value)) return *image;
  return curve_of(std::get<Spectrum>(value), found ? found->where : SourcePosition{}, world.door);
}

double number(const Parameters& parameters, std::string_view name, double absent, World& world) {
  const TextureValue value = texture(parameters, name, absent, TextureKind::number, world);
  if (const auto* spectrum = std::get_if<Spectrum>(&value)) return number_of(*spectrum).value_or(absent);
  const Parameter* found = parameters.find(name, {"texture"}, world.door);
  world.door.note(found->where,
                  fmt::format("\"{}\" cannot vary over a surface here: {} in its place", name, absent));
  return absent;
}

std::optional<spec::TextureFile> image(const std::string& name, const SourcePosition& where, World& world) {
  const TextureValue* known = find_texture(TextureKind::number, name, where, world);
  if (known == nullptr) return std::nullopt;
  if (const auto* texture = std::get_if<spec::Texture>(known)) {
    if (holds_codes(texture->file.image.value) && std::holds_alternative<spec::Rgb>(texture->of))
      world.door.note(where, kLinearRelief);
    return texture->file;
  }
  world.door.note(where, fmt::format("the texture \"{}\" is no image: dropped", name));
  return std::nullopt;
}

std::optional<spec::TextureFile> image_file(const Parameters& parameters, const SourcePosition& where,
                                            World& world) {
  Door& door = world.door;
  const Parameter* name = parameters.find("filename", {"string"}, door);
  if (name == nullptr) {
    door.diagnostics.error(where, "an image without \"filename\"");
    return std::nullopt;
  }
  const auto path = world.folder / name->texts.front();
  if (!door.take_file(path, name->where)) return std::nullopt;
  spec::TextureFile file;
  file.image = {{door.name_of(path)}, name->where};
  file.mapping.scale = {parameters.number("uscale", 1, door), parameters.number("vscale", 1, door)};
  file.mapping.offset = {parameters.number("udelta", 0, door), parameters.number("vdelta", 0, door)};
  const std::string wrap = parameters.text("wrap", "repeat", door);
  const std::vector<std::string> wraps{"black", "clamp", "octahedralsphere", "repeat"};
  if (std::ranges::find(wraps, wrap) == wraps.end())
    door.diagnostics.error(where, unknown_name("wrap mode", wrap, wraps));
  if (wrap != "repeat") file.mapping.wrap = TextureWrap::clamp;
  if (wrap == "black" || wrap == "octahedralsphere")
    door.note(where, fmt::format("an image beyond its edges is as at them here, not \"{}\"", wrap));
  if (parameters.text("filter", "bilinear", door) == "point") file.mapping.filter = TextureFilter::nearest;
  return file;
}

spec::Ior metal_index(const Parameters& parameters, std::string_view eta, std::string_view k, World& world) {
  static constexpr std::initializer_list<const char*> kTypes{"spectrum", "rgb", "float"};
  const Parameter* n = parameters.find(eta, kTypes, world.door);
  const Parameter* extinction = parameters.find(k, kTypes, world.door);
  const auto name_of = [](const Parameter* said, const char* absent) {
    if (said == nullptr) return std::string(absent);
    return said->texts.empty() ? std::string() : said->texts.front();
  };
  const std::string n_name = name_of(n, kCopperEta);
  const std::string k_name = name_of(extinction, kCopperK);
  spec::Ior ior;
  if (n != nullptr || extinction != nullptr) ior.where = n != nullptr ? n->where : extinction->where;
  if (metal_of(n_name, kEta) == metal_of(k_name, kK)) {
    if (const auto metal = renamed(kMetals, metal_of(n_name, kEta))) {
      ior.value = *metal;
      return ior;
    }
  }
  const auto said_or = [&](const Parameter* said, const char* copper) {
    return (said ? spectrum_of(*said, world) : file_or_name(copper, ior.where, world)).value_or(1.0);
  };
  return index_of(said_or(n, kCopperEta), said_or(extinction, kCopperK), ior.where, world.door);
}

spec::Ior glass_index(const Parameters& parameters, std::string_view eta, World& world) {
  const Parameter* n = parameters.find(eta, {"spectrum", "float", "rgb", "texture"}, world.door);
  spec::Ior ior;
  ior.value = 1.5;
  if (n == nullptr) return ior;
  const Spectrum value = spectrum(parameters, eta, 1.5, world);
  ior = index_of(value, 0.0, n->where, world.door);
  if (const auto* constant = std::get_if<spec::MetalIor>(&ior.value)) ior.value = double{constant->n};
  return ior;
}

}  // namespace abbe::doors::pbrt
