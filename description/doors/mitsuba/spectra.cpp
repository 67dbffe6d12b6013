#include "description/doors/mitsuba/spectra.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/doors/shared/picture.h"
#include "description/doors/shared/spectrum_file.h"
#include "io/text.h"
#include "spectral/colorimetry.h"

namespace abbe::doors::mitsuba {
namespace {

// The property of that name that says a spectrum.
const Element* find_spectrum(const Object& object, std::string_view name) {
  return object.find(name, {"rgb", "spectrum", "float", "integer", "texture"});
}

// #rrggbb, sRGB-encoded.
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

std::optional<Spectrum> rgb_of(const Element& element, const World& world) {
  if (const auto code = hexadecimal(element["value"])) return *code;
  const auto numbers = numbers_of(element["value"]);
  if (numbers && numbers->size() == 1) return LinearRgb{numbers->front(), numbers->front(), numbers->front()};
  if (numbers && numbers->size() == 3) return LinearRgb{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  world.door.diagnostics.error(
      element.where, fmt::format("expected a colour of three numbers (got \"{}\")", element["value"]));
  return std::nullopt;
}

// "nm:value, nm:value".
std::optional<Spectrum> pairs_of(const Element& element, const World& world) {
  std::string text = element["value"];
  for (char& c : text)
    if (c == ':') c = ' ';
  const auto numbers = numbers_of(text);
  if (!numbers || numbers->size() % 2 != 0) {
    world.door.diagnostics.error(
        element.where, fmt::format("expected pairs wavelength:value (got \"{}\")", element["value"]));
    return std::nullopt;
  }
  Samples samples{{}, {}, Outside::zero};
  for (std::size_t i = 0; i < numbers->size(); i += 2) {
    samples.nm.push_back((*numbers)[i]);
    samples.values.push_back((*numbers)[i + 1]);
  }
  if (!check_samples(samples, element.where, world.door)) return std::nullopt;
  return samples;
}

std::optional<Spectrum> samples_of_lists(const Object& object, const World& world) {
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
  if (samples.nm.size() != samples.values.size()) {
    world.door.diagnostics.error(object.where(), "as many values as wavelengths are needed");
    return std::nullopt;
  }
  if (!check_samples(samples, object.where(), world.door)) return std::nullopt;
  return samples;
}

// A spectrum that is an object with a type.
std::optional<Spectrum> typed(const Object& object, const World& world) {
  const std::string& type = object.type();
  if (type == "uniform") return object.number("value", 1);
  if (type == "d65") return scaled(Shipped{"D65"}, object.number("scale", 1));
  if (type == "blackbody") return Temperature{object.number("temperature", 5000)};
  if (type == "regular" || type == "irregular") return samples_of_lists(object, world);
  if (type == "srgb" || type == "srgb_d65") return spectrum(object, "color", 1.0, world);
  world.door.diagnostics.error(
      object.where(),
      unknown_name("spectrum", type,
                   std::vector<std::string>{"blackbody", "d65", "irregular", "regular", "srgb", "uniform"}));
  return std::nullopt;
}

// What stands for an image or pattern where nothing may vary.
Spectrum stand_in(const Object& texture, const World& world) {
  world.door.note(
      texture.where(),
      fmt::format("a texture \"{}\" has no counterpart here: one value in its place", texture.type()));
  if (texture.has("color0")) return spectrum(texture, "color0", 0.5, world);
  return 0.5;
}

TextureValue texture_of(const Element& element, RunsOfV v, const World& world) {
  const Object object(element, world);
  if (object.type() == "bitmap") {
    auto file = image(object, v, world);
    if (!file) return Spectrum(0.5);
    return colours_of(*std::move(file), object.truth("raw", false), object.where(), world.door);
  }
  return stand_in(object, world);
}

}  // namespace

std::optional<Spectrum> spectrum_of(const Element& element, const World& world) {
  if (element.tag == "rgb") return rgb_of(element, world);
  if (element.tag == "texture") return stand_in(Object(element, world), world);
  if (!element["type"].empty()) {
    const Object object(element, world);
    auto spectrum = typed(object, world);
    object.note_unused();
    return spectrum;
  }
  if (!element["filename"].empty()) {
    auto samples = read_spectrum_file(world.folder / element["filename"], element.where, world.door);
    if (!samples) return std::nullopt;
    samples->outside = Outside::zero;
    return *samples;
  }
  if (const auto number = parse_number(element["value"])) return *number;
  return pairs_of(element, world);
}

Spectrum spectrum(const Object& object, std::string_view name, const Spectrum& absent, const World& world) {
  const Element* found = find_spectrum(object, name);
  return found ? spectrum_of(*found, world).value_or(absent) : absent;
}

TextureValue texture(const Object& object, std::string_view name, const Spectrum& absent, RunsOfV v,
                     const World& world) {
  const Element* found = object.find(name, {"rgb", "spectrum", "float", "texture"});
  if (found == nullptr) return absent;
  if (found->tag == "texture") return texture_of(*found, v, world);
  return spectrum_of(*found, world).value_or(absent);
}

spec::Reflectance reflectance(const Object& object, std::string_view name, double absent, RunsOfV v,
                              const World& world) {
  TextureValue value = texture(object, name, absent, v, world);
  if (auto* picture = std::get_if<spec::Texture>(&value)) return *picture;
  return curve_of(std::get<Spectrum>(value), object.place_of(name), world.door);
}

double number(const Object& object, std::string_view name, double absent, const World& world) {
  return number_of(spectrum(object, name, absent, world)).value_or(absent);
}

std::optional<spec::TextureFile> image(const Object& texture, RunsOfV v, const World& world) {
  if (texture.type() != "bitmap") {
    world.door.note(texture.where(), fmt::format("a texture \"{}\" is no image: dropped", texture.type()));
    return std::nullopt;
  }
  const auto path = world.folder / texture.text("filename", "");
  if (!world.door.take_file(path, texture.where())) return std::nullopt;
  spec::TextureFile file;
  file.image = {{world.door.name_of(path)}, texture.where()};
  const std::string wrap = texture.text("wrap_mode", "repeat");
  const std::vector<std::string> wraps{"clamp", "mirror", "repeat"};
  if (wrap == "clamp") file.mapping.wrap = TextureWrap::clamp;
  if (wrap == "mirror") world.door.note(texture.where(), kNoMirroredImages);
  if (std::ranges::find(wraps, wrap) == wraps.end())
    world.door.diagnostics.error(texture.place_of("wrap_mode"), unknown_name("wrap mode", wrap, wraps));
  if (texture.text("filter_type", "bilinear") == "nearest") file.mapping.filter = TextureFilter::nearest;
  const Imath::M44d m = texture.transform("to_uv");
  if (m[0][1] != 0 || m[1][0] != 0)
    world.door.note(texture.where(), "an image is not turned on a surface here: dropped");
  // Rows run down there: an image lies at 1 - (a v + b) of what is up here.
  const bool down = v == RunsOfV::down;
  file.mapping.scale = {m[0][0], down ? -m[1][1] : m[1][1]};
  file.mapping.offset = {m[3][0], 1 - m[3][1] - (down ? 0 : m[1][1])};
  texture.ignore({"raw", "format"});
  texture.note_unused();
  return file;
}

double y_of_one() {
  return sum_product(color_matching(Observer::cie1931).y, Curve(1.0), SumRange{360, 830});
}

LampSpectrum lamp(const Object& object, std::string_view name, const World& world) {
  const Element* said = find_spectrum(object, name);
  const Spectrum given = said ? spectrum_of(*said, world).value_or(1.0) : 1.0;
  if (said != nullptr && (*said)["type"] == "uniform")
    return lamp_of(given, number_of(given).value_or(1) * y_of_one(), object.where(), world.door);
  if (const auto* table = std::get_if<Shipped>(&given))
    return lamp_of(given, table->factor * y_of_one(), object.where(), world.door);
  return absolute_lamp_of(given, 1, y_of_one(), object.where(), world.door);
}

}  // namespace abbe::doors::mitsuba
