#include "importers/mitsuba/spectra.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "importers/shared/materials.h"
#include "importers/shared/spectra.h"
#include "io/text.h"
#include "spectral/colorimetry.h"

namespace abbe::importers::mitsuba {
namespace {

const Element* find_spectrum(const Object& object, std::string_view name) {
  return object.find(name, {"rgb", "spectrum", "float", "integer", "texture"});
}

// Parses an sRGB-encoded "#rrggbb".
std::optional<LinearRgb> hexadecimal(const std::string& text) {
  if (text.size() != 7 || text[0] != '#' ||
      text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
    return std::nullopt;
  const auto code = static_cast<std::uint32_t>(std::stoul(text.substr(1), nullptr, 16));
  const auto channel = [code](int shift) {
    return srgb_decoded(static_cast<double>((code >> shift) & 0xFFU) / 255);
  };
  return LinearRgb{channel(16), channel(8), channel(0)};
}

std::optional<Spectrum> rgb_of(const Element& element, const ImportState& state) {
  if (const auto code = hexadecimal(element["value"])) return *code;
  const auto numbers = numbers_of(element["value"]);
  if (numbers && numbers->size() == 1) return LinearRgb{numbers->front(), numbers->front(), numbers->front()};
  if (numbers && numbers->size() == 3) return LinearRgb{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  return state.importer.fail(
      element.where, fmt::format("expected a colour of three numbers (got \"{}\")", element["value"]));
}

// Parses "nm:value, nm:value".
std::optional<Spectrum> pairs_of(const Element& element, const ImportState& state) {
  std::string text = element["value"];
  for (char& c : text)
    if (c == ':') c = ' ';
  const auto numbers = numbers_of(text);
  if (!numbers || numbers->size() % 2 != 0)
    return state.importer.fail(element.where,
                               fmt::format("expected pairs wavelength:value (got \"{}\")", element["value"]));
  return samples_of_pairs(*numbers, element.where, state.importer);
}

std::optional<Spectrum> samples_of_lists(const Object& object) {
  Samples samples{{}, {}, Outside::zero};
  const auto list = [&](std::string_view name) {
    return numbers_of(object.text(name, "")).value_or(std::vector<double>{});
  };
  samples.values = list("values");
  if (object.type() == "regular") {
    const double low = object.number("wavelength_min", 360);
    const double high = object.number("wavelength_max", 830);
    for (std::size_t i = 0; i < samples.values.size(); ++i)
      samples.nm.push_back(low + (high - low) * static_cast<double>(i) /
                                     static_cast<double>(samples.values.size() - 1));
  } else {
    samples.nm = list("wavelengths");
  }
  if (samples.nm.size() != samples.values.size())
    return object.fail("the numbers of wavelengths and values must be equal");
  return checked(std::move(samples), object.where(), object.importer());
}

std::optional<Spectrum> typed_spectrum(const Object& object) {
  const std::string& type = object.type();
  if (type == "uniform") return object.number("value", 1);
  if (type == "d65") return scaled(ShippedTable{"D65"}, object.number("scale", 1));
  if (type == "blackbody") return Temperature{object.number("temperature", 5000)};
  if (type == "regular" || type == "irregular") return samples_of_lists(object);
  if (type == "srgb" || type == "srgb_d65") return spectrum(object, "color", 1.0);
  object.importer().is_known("spectrum", type,
                             {"blackbody", "d65", "irregular", "regular", "srgb", "uniform"}, object.where());
  return std::nullopt;
}

Spectrum constant_replacement(const Object& texture) {
  texture.note(fmt::format("a texture \"{}\" is not supported: replaced by a constant", texture.type()));
  if (texture.has("color0")) return spectrum(texture, "color0", 0.5);
  return 0.5;
}

TextureValue texture_of(const Object& texture, VDirection v) {
  if (texture.type() != "bitmap") return constant_replacement(texture);
  auto file = image(texture, v);
  if (!file) return Spectrum(0.5);
  return colours_of(*std::move(file), texture.boolean("raw", false), texture.where(), texture.importer());
}

}  // namespace

std::optional<Spectrum> spectrum_of(const Element& element, const ImportState& state) {
  if (element.tag == "rgb") return rgb_of(element, state);
  if (element.tag == "texture") return constant_replacement(Object(element, state));
  if (!element["type"].empty()) {
    const Object object(element, state);
    auto spectrum = typed_spectrum(object);
    object.note_unused();
    return spectrum;
  }
  if (!element["filename"].empty())
    return read_spectrum_file(state.folder / element["filename"], element.where, state.importer);
  if (const auto number = parse_number(element["value"])) return *number;
  return pairs_of(element, state);
}

Spectrum spectrum(const Object& object, std::string_view name, const Spectrum& fallback) {
  const Element* found = find_spectrum(object, name);
  return found ? spectrum_of(*found, object.state()).value_or(fallback) : fallback;
}

TextureValue texture(const Object& object, std::string_view name, const Spectrum& fallback, VDirection v) {
  const Element* found = object.find(name, {"rgb", "spectrum", "float", "texture"});
  if (found == nullptr) return fallback;
  if (found->tag == "texture") return texture_of(Object(*found, object.state()), v);
  return spectrum_of(*found, object.state()).value_or(fallback);
}

spec::Reflectance reflectance(const Object& object, std::string_view name, double fallback, VDirection v) {
  TextureValue value = texture(object, name, fallback, v);
  if (auto* picture = std::get_if<spec::Texture>(&value)) return *picture;
  return curve_of(std::get<Spectrum>(value), object.position_of(name), object.importer());
}

double number(const Object& object, std::string_view name, double fallback) {
  return number_of(spectrum(object, name, fallback)).value_or(fallback);
}

std::optional<spec::TextureFile> image(const Object& texture, VDirection v) {
  if (texture.type() != "bitmap") {
    texture.note(fmt::format("a texture \"{}\" is not an image: dropped", texture.type()));
    return std::nullopt;
  }
  const auto path = texture.state().folder / texture.text("filename", "");
  if (!texture.importer().check_file(path, texture.where())) return std::nullopt;
  spec::TextureFile file;
  file.image = {{texture.importer().name_of(path)}, texture.where()};
  const std::string wrap = texture.text("wrap_mode", "repeat");
  texture.importer().is_known("wrap mode", wrap, {"clamp", "mirror", "repeat"},
                              texture.position_of("wrap_mode"));
  if (wrap == "clamp") file.mapping.wrap = TextureWrap::clamp;
  if (wrap == "mirror") texture.note(kNoMirroredImages);
  if (texture.text("filter_type", "bilinear") == "nearest") file.mapping.filter = TextureFilter::nearest;
  const Imath::M44d m = texture.transform("to_uv");
  if (m[0][1] != 0 || m[1][0] != 0)
    texture.note("rotation of an image on a surface is not supported: dropped");
  // v points down in Mitsuba, up in Abbe: the image coordinate is 1 - (a v + b) of Mitsuba's v.
  const bool down = v == VDirection::down;
  file.mapping.scale = {m[0][0], down ? -m[1][1] : m[1][1]};
  file.mapping.offset = {m[3][0], 1 - m[3][1] - (down ? 0 : m[1][1])};
  texture.ignore({"raw", "format"});
  texture.note_unused();
  return file;
}

double y_integral() {
  return sum_product(color_matching(Observer::cie1931).y, Curve(1.0), SumRange{360, 830});
}

ImportedLightSpectrum light_spectrum(const Object& object, std::string_view name) {
  const Element* element = find_spectrum(object, name);
  const Spectrum given = element ? spectrum_of(*element, object.state()).value_or(1.0) : 1.0;
  if (element != nullptr && (*element)["type"] == "uniform")
    return light_spectrum_of(given, number_of(given).value_or(1) * y_integral(), object.where(),
                             object.importer());
  if (const auto* table = std::get_if<ShippedTable>(&given))
    return light_spectrum_of(given, table->factor * y_integral(), object.where(), object.importer());
  return absolute_light_spectrum_of(given, y_integral(), object.where(), object.importer());
}

}  // namespace abbe::importers::mitsuba
