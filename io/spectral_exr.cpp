#include "io/spectral_exr.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <utility>

#include "io/error.h"
#include "io/text.h"

namespace abbe {
namespace {

constexpr const char* kVersionKey = "spectralLayoutVersion";
constexpr const char* kVersion = "1.0";
constexpr const char* kUnitsKey = "emissiveUnits";
constexpr const char* kUnits = "W.m^-2.sr^-1";
constexpr double kLightSpeed = 299792458;  // [m/s]

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw Error(ErrorCode::input, where, what);
}

// True if the name begins and ends like that of a spectral channel.
bool looks_spectral(const std::string& name) {
  static const std::regex kPattern(R"(^(S[0-3]|T)\..*(m|Hz)$)");
  return std::regex_match(name, kPattern);
}

int power_of_ten(const std::string& prefix) {
  static const std::map<std::string, int> kPowers{
      {"Y", 24}, {"Z", 21}, {"E", 18}, {"P", 15}, {"T", 12}, {"G", 9},  {"M", 6},  {"k", 3},  {"h", 2},
      {"da", 1}, {"", 0},   {"d", -1}, {"c", -2}, {"m", -3}, {"u", -6}, {"n", -9}, {"p", -12}};
  return kPowers.at(prefix);
}

void require_attribute(const Image& image, const std::string& key, const std::string& allowed,
                       const std::string& where) {
  const auto found = image.metadata.find(key);
  if (found == image.metadata.end())
    refuse(where, fmt::format("missing attribute \"{}\" (allowed \"{}\")", key, allowed));
  if (found->second != allowed)
    refuse(where, fmt::format("unsupported {} (got \"{}\", allowed \"{}\")", key, found->second, allowed));
}

using Component = std::vector<SpectralBand>;

void sort_by_wavelength(Component& bands, const std::string& where) {
  std::ranges::sort(bands, {}, &SpectralBand::center_nm);
  const auto twice = std::ranges::adjacent_find(bands, {}, &SpectralBand::center_nm);
  if (twice != bands.end()) refuse(where, fmt::format("two channels at {} nm", twice->center_nm));
}

void check_polarisation(const Image& image, const std::array<Component, 4>& stokes,
                        const std::string& where) {
  if (std::all_of(stokes.begin() + 1, stokes.end(), [](const Component& c) { return c.empty(); })) return;
  const auto handedness = image.metadata.find(kHandednessKey);
  if (handedness == image.metadata.end() ||
      (handedness->second != "left" && handedness->second != kRightHanded))
    refuse(
        where,
        fmt::format("polarised, but the attribute \"{}\" is missing or invalid (allowed \"left\", \"right\")",
                    kHandednessKey));
  for (std::size_t i = 1; i < stokes.size(); ++i)
    if (!std::ranges::equal(stokes[0], stokes[i], {}, &SpectralBand::center_nm, &SpectralBand::center_nm))
      refuse(where, fmt::format("S{} has other wavelengths than S0", i));
}

void make_right_handed(Image& image, Component& s3) {
  if (std::exchange(image.metadata.at(kHandednessKey), kRightHanded) == kRightHanded) return;
  for (SpectralBand& band : s3)
    for (float& value : band.radiance) value = -value;
}

}  // namespace

std::string spectral_channel(double center_nm, int component) {
  std::string name = fmt::format("S{}.{:.6f}nm", component, center_nm);
  name[name.rfind('.')] = ',';
  return name;
}

std::optional<SpectralName> parse_spectral_channel(std::string_view name, const std::string& where) {
  static const std::regex kGrammar(
      R"(^(?:S([0-3])|(T))\.(\d*,?\d*)([Ee][+-]?\d+)?(da|[YZEPTGMkhdcmunp])?(m|Hz)$)");
  const std::string text(name);
  if (!looks_spectral(text)) return std::nullopt;
  std::smatch parts;
  if (!std::regex_match(text, parts, kGrammar))
    refuse(where, fmt::format("channel \"{}\" is not a valid spectral name (expected a name like S0.550,5nm)",
                              name));
  std::string digits = parts[3].str() + parts[4].str();
  std::replace(digits.begin(), digits.end(), ',', '.');
  if (digits.starts_with('.')) digits.insert(0, "0");
  const double number = parse_number(digits).value_or(0);
  const int power = power_of_ten(parts[5].str());
  const double center_nm = parts[6] == "Hz" ? kLightSpeed / (number * std::pow(10.0, power)) * 1e9
                                            : number * std::pow(10.0, power + 9);
  if (!std::isfinite(center_nm) || !(center_nm > 0))
    refuse(where, fmt::format("channel \"{}\" names no wavelength", name));
  return SpectralName{parts[2].matched ? 'T' : parts[1].str().front(), center_nm};
}

bool is_spectral(const Image& image) {
  return image.metadata.contains(kVersionKey) ||
         std::ranges::any_of(image.channels, [](const ImageChannel& channel) {
           return looks_spectral(channel.name) && (channel.name[0] == 'T' || channel.name[1] == '0');
         });
}

std::vector<double> band_edges(const std::vector<SpectralBand>& bands) {
  std::vector<double> edges{0};
  for (std::size_t i = 0; i + 1 < bands.size(); ++i)
    edges.push_back((bands[i].center_nm + bands[i + 1].center_nm) / 2);
  edges.front() = 2 * bands.front().center_nm - edges[1];
  edges.push_back(2 * bands.back().center_nm - edges.back());
  return edges;
}

Image spectral_layout(const SpectralImage& image) {
  Image layout{image.width, image.height, image.others, image.metadata};
  for (const SpectralBand& band : image.bands)
    layout.channels.push_back({spectral_channel(band.center_nm), band.radiance});
  for (std::size_t i = 0; i < image.polarised.size(); ++i)
    for (const SpectralBand& band : image.polarised[i])
      layout.channels.push_back({spectral_channel(band.center_nm, static_cast<int>(i) + 1), band.radiance});
  if (image.is_polarised()) layout.metadata[kHandednessKey] = kRightHanded;
  layout.metadata[kVersionKey] = kVersion;
  layout.metadata[kUnitsKey] = kUnits;
  return layout;
}

SpectralImage spectral_image(Image image, const std::string& where) {
  require_attribute(image, kVersionKey, kVersion, where);
  SpectralImage result{image.width, image.height, {}, {}, {}};
  std::array<Component, 4> stokes;
  for (ImageChannel& channel : image.channels) {
    const auto name = parse_spectral_channel(channel.name, where);
    if (!name) {
      result.others.push_back(std::move(channel));
      continue;
    }
    if (name->kind == 'T')
      refuse(where, fmt::format("channel \"{}\" is a reflectance (allowed radiances, S0)", channel.name));
    stokes.at(static_cast<std::size_t>(name->kind - '0'))
        .push_back({name->center_nm, std::move(channel.values)});
  }
  for (Component& component : stokes) sort_by_wavelength(component, where);
  if (stokes[0].size() < 2)
    refuse(where, fmt::format("too few bands of radiance to infer their widths (got {}, allowed 2 or more)",
                              stokes[0].size()));
  require_attribute(image, kUnitsKey, kUnits, where);
  check_polarisation(image, stokes, where);
  result.bands = std::move(stokes[0]);
  std::move(stokes.begin() + 1, stokes.end(), result.polarised.begin());
  if (result.is_polarised()) make_right_handed(image, result.polarised[2]);
  result.metadata = std::move(image.metadata);
  return result;
}

}  // namespace abbe
