#include "cli/arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "io/json_values.h"
#include "io/text.h"
#include "sensor/film/crop.h"

namespace abbe::cli {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& got, const std::string& allowed) {
  throw Error(ErrorCode::usage, option, fmt::format("got {}, allowed {}", got, allowed));
}

ServerAddress parse_address(const std::string& option, const std::string& text, int min_port) {
  ServerAddress address;
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos) address.host = text.substr(0, colon);
  if (address.host.starts_with('[') && address.host.ends_with(']'))
    address.host = address.host.substr(1, address.host.size() - 2);
  if (address.host.empty()) refuse(option, "\"" + text + "\"", "port or address:port");
  address.port = static_cast<int>(parse_integer(option, text.substr(colon + 1), min_port, 65535));
  return address;
}

}  // namespace

std::vector<double> parse_numbers(const std::string& option, const std::string& text, double low,
                                  double high) {
  std::vector<double> numbers;
  for (const std::string& piece : split(text, ',')) {
    const std::optional<double> number = parse_number(piece);
    if (!number) refuse(option, "\"" + text + "\"", "numbers separated by commas");
    if (!(*number >= low && *number <= high))
      refuse(option, piece, fmt::format("[{:.10g}, {:.10g}]", low, high));
    numbers.push_back(*number);
  }
  return numbers;
}

std::int64_t parse_integer(const std::string& option, const std::string& text, std::int64_t low,
                           std::int64_t high) {
  std::int64_t exact = 0;  // exact above 2^53, where doubles have gaps
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exact);
  const bool digits = error == std::errc() && end == text.data() + text.size();
  const std::optional<double> number = parse_number(text);
  const bool good = digits ? exact >= low && exact <= high
                           : number && *number == std::floor(*number) &&
                                 *number >= static_cast<double>(low) && *number <= static_cast<double>(high);
  if (!good) refuse(option, "\"" + text + "\"", fmt::format("whole numbers in [{}, {}]", low, high));
  return digits ? exact : static_cast<std::int64_t>(*number);
}

std::size_t parse_choice(const std::string& option, const std::string& text,
                         const std::vector<std::string>& names) {
  const auto chosen = std::ranges::find(names, text);
  if (chosen == names.end()) refuse(option, "\"" + text + "\"", fmt::format("{}", fmt::join(names, ", ")));
  return static_cast<std::size_t>(chosen - names.begin());
}

std::array<double, 3> parse_triple(const std::string& option, const std::string& text) {
  const std::vector<double> numbers = parse_numbers(option, text, -kLargestFloat, kLargestFloat);
  if (numbers.size() != 3) refuse(option, "\"" + text + "\"", "three numbers separated by commas");
  return {numbers[0], numbers[1], numbers[2]};
}

double parse_seconds(const std::string& option, const std::string& text) {
  const char unit = text.empty() ? ' ' : text.back();
  const double factor = unit == 'm' ? 60 : unit == 'h' ? 3600 : 1;
  const bool has_unit = unit == 's' || unit == 'm' || unit == 'h';
  const std::optional<double> number = parse_number(text.substr(0, text.size() - (has_unit ? 1 : 0)));
  if (!number || *number <= 0) refuse(option, "\"" + text + "\"", "a time above 0 such as 60s, 2m or 1h");
  return *number * factor;
}

std::size_t parse_bytes(const std::string& option, const std::string& text) {
  constexpr double kMost = 1e18;
  const std::size_t unit = text.empty() ? std::string::npos : std::string_view("kMG").find(text.back());
  const bool has_unit = unit != std::string_view::npos;
  const std::optional<double> number = parse_number(text.substr(0, text.size() - (has_unit ? 1 : 0)));
  const double bytes = number.value_or(0) * (has_unit ? std::pow(1e3, static_cast<double>(unit + 1)) : 1);
  if (!(bytes >= 1 && bytes <= kMost))
    refuse(option, "\"" + text + "\"", "an amount of memory such as 4G, 500M, 20k or a number of bytes");
  return static_cast<std::size_t>(bytes);
}

double parse_fraction(const std::string& option, const std::string& text) {
  const bool percent = text.ends_with('%');
  const std::optional<double> number = parse_number(text.substr(0, text.size() - (percent ? 1 : 0)));
  const double fraction = number.value_or(0) / (percent ? 100 : 1);
  if (!(fraction > 0 && fraction < 1))
    refuse(option, "\"" + text + "\"", "a fraction in (0, 1) such as 0.5% or 0.005");
  return fraction;
}

CalibrationFrame parse_calibration_frame(const std::string& option, const std::string& text) {
  if (text == "bias") return BiasFrame{};
  if (text == "dark") return DarkFrame{};
  constexpr std::string_view kFlat = "flat:";
  if (text + ":" == kFlat) return FlatFrame{};
  if (!text.starts_with(kFlat))
    throw Error(ErrorCode::usage, option,
                "got \"" + text + "\", allowed bias, dark, flat or flat:FRACTION such as flat:0.5");
  return FlatFrame{parse_numbers(option, text.substr(kFlat.size()), 1e-9, 10).at(0)};
}

Crop parse_crop(const std::string& option, const std::string& text) {
  const std::optional<Crop> crop = abbe::parse_crop(text);
  if (!crop) refuse(option, "\"" + text + "\"", "whole pixels x0,y0,x1,y1 with x0 < x1 and y0 < y1");
  return *crop;
}

LightFactor parse_light_factor(const std::string& option, const std::string& text) {
  constexpr double kMost = 1e30;
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos || sign == 0) refuse(option, "\"" + text + "\"", "NAME=FACTOR");
  return {text.substr(0, sign), parse_numbers(option, text.substr(sign + 1), 0, kMost)};
}

Crop requested_pixels(const Image& film, const std::optional<Crop>& requested) {
  const std::vector<Crop> areas = recorded_areas(film);
  const std::string allowed = "within " + to_text(areas);
  if (!requested) {
    if (areas.size() > 1) refuse("--crop", "no rectangle for a film with gaps", allowed);
    return areas.front();
  }
  std::size_t covered = 0;
  for (const Crop& area : areas)
    if (const auto common = common_pixels(area, *requested)) covered += pixel_count(*common);
  if (covered < pixel_count(*requested)) refuse("--crop", to_text(*requested), allowed);
  return *requested;
}

LayerChoice parse_layer_choice(const std::string& option, const std::string& text) {
  constexpr int kDefaultBounces = 8;
  constexpr int kMaxBounces = 64;
  const std::size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  const std::string argument = colon == std::string::npos ? "" : text.substr(colon + 1);
  if ((kind != "lights" && kind != "bounces") || (colon != std::string::npos && argument.empty()))
    refuse(option, "\"" + text + "\"", "lights, lights:NAME,..., bounces or bounces:N");
  if (kind == "lights") return {{}, argument.empty() ? std::vector<std::string>() : split(argument, ',')};
  return {
      argument.empty() ? kDefaultBounces : static_cast<int>(parse_integer(option, argument, 1, kMaxBounces)),
      {}};
}

std::vector<Feature> parse_feature_list(const std::string& option, const std::string& text) {
  const std::optional<std::vector<Feature>> features = parse_features(text);
  if (!features)
    refuse(option, "\"" + text + "\"", fmt::format("names out of {}", fmt::join(kFeatureNames, ", ")));
  return *features;
}

SampleRange parse_sample_range(const std::string& option, const std::string& text) {
  const std::optional<SampleRanges> ranges = parse_sample_ranges(text);
  if (!ranges || ranges->size() != 1) refuse(option, "\"" + text + "\"", "whole numbers a:b with a < b");
  return ranges->front();
}

ServerAddress parse_server_address(const std::string& option, const std::string& text) {
  return parse_address(option, text, 0);
}

ServerAddress parse_viewer_address(const std::string& option, const std::string& text) {
  return parse_address(option, text, 1);
}

Override parse_override(const std::string& option, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || !text.starts_with('/'))
    refuse(option, "\"" + text + "\"", "/pointer=value, such as /render/samples=64");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace abbe::cli
