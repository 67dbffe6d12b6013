#include "description/reflectance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "io/picture.h"

namespace abbe {

static schema::Fields fields(schema::Tag<TextureMapping>) {
  using namespace schema;
  constexpr Range kMapping{-1e6, 1e6};
  return describe(
      "texture_mapping", "",
      {defaulted("filter", &TextureMapping::filter,
                 enumeration<TextureFilter>("filter", {"bilinear", "nearest"}),
                 "Interpolation between the centers of texels."),
       defaulted("wrap", &TextureMapping::wrap, enumeration<TextureWrap>("wrap", {"repeat", "clamp"}),
                 "Extension past the edges of the image."),
       defaulted("scale", &TextureMapping::scale, kMapping,
                 "Texture coordinates are scale * (u, v) + offset."),
       defaulted("offset", &TextureMapping::offset, kMapping,
                 "Texture coordinates are scale * (u, v) + offset.")});
}

namespace spec {

using namespace schema;

Fields fields(Tag<TextureFile>) {
  return describe(
      "texture_file", "",
      {field("image", &TextureFile::image, "An EXR, PNG, TIFF or other file that OpenImageIO reads."),
       inlined(&TextureFile::mapping)});
}

static Fields fields(Tag<Texture>) {
  return describe("texture", "An image whose channels multiply spectra.",
                  {inlined(&Texture::file),
                   one_of(&Texture::of,
                          under<Weights>("weights", by_name<Curve>("spectra by channel", 1),
                                         "Spectrum that each channel multiplies; channel values are linear."),
                          under<Rgb>("rgb",
                                     "true: channels R, G, B are a colour. It is linear in files of floats, "
                                     "else encoded as the file declares, or as sRGB."))});
}

ValueType value_type(Tag<Reflectance>) {
  return forms<Reflectance>("reflectance", "a reflectance", form<Texture>(Json::object, {"image"}),
                            form<Curve>(Json::any));
}

}  // namespace spec
}  // namespace abbe

namespace abbe::description {
namespace {

// Reflectances outside [0, 1] by up to this count as rounding of the file and are clamped.
constexpr double kSlight = 1e-3;
// Reflectances outside [0, 1] by up to this count as rounding of the sum.
constexpr double kSumRounding = 1e-6;

/// The channels of an image and the spectra that they multiply.
struct Weights {
  std::vector<std::string> channels;
  std::vector<Curve> spectra;
  Encoding encoding = kLinearEncoding;
};

std::optional<Weights> build(const spec::Weights& spec, LoadContext& context) {
  Weights weights;
  for (const auto& [channel, curve, where] : spec.value) {
    auto spectrum = build(curve, {"reflectance", spec::kValue}, context);
    if (!spectrum) return std::nullopt;
    weights.channels.push_back(channel);
    weights.spectra.push_back(std::move(*spectrum));
  }
  return weights;
}

std::optional<Weights> build(const spec::Rgb& spec, const TextureFile& file, LoadContext& context) {
  if (!spec.value)
    return context.refuse(spec.where, "an image that is not rgb needs weights (got false, allowed true)");
  if (const auto fault = rec709_fault(file.image)) {
    file.refuse(*fault, ErrorCode::input, context);
    return std::nullopt;
  }
  context.diagnostics.warning(file.where,
                              fmt::format("texture \"{}\": RGB values do not determine a spectrum: the "
                                          "smooth spectrum of the same colour under D65 is used",
                                          file.name));
  const ImageChannel* alpha = file.image.find("A");
  if (alpha && std::ranges::any_of(alpha->values, [](float value) { return value != 1; }))
    context.diagnostics.warning(
        file.where,
        fmt::format("texture \"{}\": its alpha channel is ignored, and colours are used as stored",
                    file.name));
  const RgbBasis& basis = rgb_basis();
  return Weights{{"R", "G", "B"},
                 {basis.red, basis.green, basis.blue},
                 recorded_encoding(file.image).value_or(Encoding{})};
}

/// Values of all spectra at one wavelength.
struct Sample {
  double nm;
  std::vector<double> values;
};

// Samples at which sums of the spectra can be extreme: at their knots, on both sides of a jump.
std::vector<Sample> extreme_samples(std::span<const Curve> spectra) {
  std::set<double> wavelengths;
  for (const Curve& spectrum : spectra)
    for (const Knot& knot : spectrum.knots()) {
      wavelengths.insert(knot.wavelength_nm);
      wavelengths.insert(std::nextafter(knot.wavelength_nm, 0.0));
    }
  std::vector<Sample> samples;
  for (const double nm : wavelengths) {
    Sample& sample = samples.emplace_back(Sample{nm, {}});
    for (const Curve& spectrum : spectra) sample.values.push_back(spectrum(nm));
  }
  return samples;
}

double excess(double reflectance) {
  return std::max(-reflectance, reflectance - 1);
}

// Removes samples at which no combination of channel values within their ranges is outside [0, 1].
void drop_harmless(std::vector<Sample>& samples, const std::vector<float>& texels) {
  if (samples.empty()) return;
  const std::size_t channels = samples[0].values.size();
  std::vector<std::array<double, 2>> ends(channels);
  for (std::size_t c = 0; c < channels; ++c) {
    ends[c] = {static_cast<double>(texels[c]), static_cast<double>(texels[c])};
    for (std::size_t i = c; i < texels.size(); i += channels) {
      ends[c][0] = std::min(ends[c][0], static_cast<double>(texels[i]));
      ends[c][1] = std::max(ends[c][1], static_cast<double>(texels[i]));
    }
  }
  std::erase_if(samples, [&](const Sample& sample) {
    double lowest = 0;
    double highest = 0;
    for (std::size_t c = 0; c < channels; ++c) {
      const auto [low, high] = std::minmax({sample.values[c] * ends[c][0], sample.values[c] * ends[c][1]});
      lowest += low;
      highest += high;
    }
    return excess(lowest) <= kSumRounding && excess(highest) <= kSumRounding;
  });
}

// True if every texel reflects between 0 and 1 at all wavelengths, up to rounding. Reports the worst texel.
bool check_reflectances(const TextureFile& file, const Weights& weights, const std::vector<float>& texels,
                        LoadContext& context) {
  std::vector<Sample> samples = extreme_samples(weights.spectra);
  drop_harmless(samples, texels);
  const std::size_t channels = weights.channels.size();
  double worst = 0.5;
  std::size_t texel = 0;
  double nm = 0;
  for (std::size_t i = 0; i < texels.size() / channels; ++i)
    for (const Sample& sample : samples) {
      double sum = 0;
      for (std::size_t c = 0; c < channels; ++c)
        sum += sample.values[c] * static_cast<double>(texels[i * channels + c]);
      if (excess(sum) <= excess(worst)) continue;
      worst = sum;
      texel = i;
      nm = sample.nm;
    }
  if (excess(worst) <= kSumRounding) return true;
  const std::string what =
      fmt::format("{} reflects {:.6g} at {:g} nm", file.texel_name(texel), worst, std::round(nm));
  if (excess(worst) > kSlight) {
    file.refuse(fmt::format("{} (allowed {})", what, Range::unit().text()), ErrorCode::scene, context);
    return false;
  }
  context.diagnostics.warning(file.where,
                              fmt::format("texture \"{}\": {}: clamped to [0, 1]", file.name, what));
  return true;
}

}  // namespace

std::optional<SpectralTexture> build(const spec::Reflectance& spec, LoadContext& context) {
  if (const auto* constant = std::get_if<spec::Curve>(&spec)) {
    auto curve = build(*constant, kReflectanceUse, context);
    if (!curve) return std::nullopt;
    return SpectralTexture(std::move(*curve));
  }
  const auto& texture = std::get<spec::Texture>(spec);
  const auto file = build(texture.file, context);
  if (!file) return std::nullopt;
  const auto* rgb = std::get_if<spec::Rgb>(&texture.of);
  auto weights = rgb ? build(*rgb, *file, context) : build(std::get<spec::Weights>(texture.of), context);
  if (!weights) return std::nullopt;
  auto texels = read_texels(*file, weights->channels, weights->encoding, context);
  if (!texels || !check_reflectances(*file, *weights, *texels, context)) return std::nullopt;
  return SpectralTexture(texture_image(*file, weights->channels.size(), std::move(*texels)),
                         std::move(weights->spectra));
}

void TextureFile::refuse(const std::string& what, ErrorCode code, LoadContext& context) const {
  context.diagnostics.error(where, fmt::format("texture \"{}\": {}", name, what), code);
}

std::string TextureFile::texel_name(std::size_t i) const {
  const auto columns = static_cast<std::size_t>(image.width);
  return fmt::format("texel ({}, {})", i % columns, i / columns);
}

std::optional<TextureFile> build(const spec::TextureFile& spec, LoadContext& context) {
  const std::string& name = spec.image.value;
  const SourcePosition& where = spec.image.where;
  const auto path = context.file(name, where);
  if (!path) return std::nullopt;
  try {
    Image image = apply_orientation(read_image(*path, context.inputs));
    const std::size_t bytes = image.memory_bytes();
    return TextureFile{name, where, std::move(image), spec.mapping, {context.inputs, bytes}};
  } catch (const Error& e) {
    return context.refuse(where, e.what(), e.code);
  }
}

std::optional<std::vector<float>> read_texels(const TextureFile& file, std::span<const std::string> channels,
                                              const Encoding& encoding, LoadContext& context) {
  context.take_memory(fmt::format("texture \"{}\"", file.name),
                      file.image.pixels() * channels.size() * sizeof(float));
  std::vector<float> texels(file.image.pixels() * channels.size());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const ImageChannel* channel = file.image.find(channels[c]);
    const bool is_colour = channels[c] == "R" || channels[c] == "G" || channels[c] == "B";
    if (channel == nullptr && is_colour) channel = file.image.find("Y");  // a grey picture
    if (channel == nullptr) {
      std::vector<std::string> names;
      for (const ImageChannel& known : file.image.channels) names.push_back(known.name);
      file.refuse(fmt::format("no channel \"{}\" (it has {})", channels[c], fmt::join(names, ", ")),
                  ErrorCode::input, context);
      return std::nullopt;
    }
    for (std::size_t i = 0; i < file.image.pixels(); ++i) {
      const float value = channel->values[i];
      if (!std::isfinite(value)) {
        file.refuse(
            fmt::format("{} of channel {} is not finite (got {})", file.texel_name(i), channel->name, value),
            ErrorCode::input, context);
        return std::nullopt;
      }
      texels[i * channels.size() + c] = static_cast<float>(encoding.decoded(static_cast<double>(value)));
    }
  }
  return texels;
}

TextureImage texture_image(const TextureFile& file, std::size_t channels, std::vector<float> texels) {
  return {static_cast<std::size_t>(file.image.width), static_cast<std::size_t>(file.image.height), channels,
          std::move(texels), file.mapping};
}

}  // namespace abbe::description
