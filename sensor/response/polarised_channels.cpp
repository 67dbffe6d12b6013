#include "sensor/response/polarised_channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe {

namespace {
constexpr std::array<std::string_view, 4> kPrefixes{"", "S1.", "S2.", "S3."};

Analyser analyser_of(int component) {
  return {0, component == 1 ? 1.0F : 0.0F, component == 2 ? 1.0F : 0.0F, component == 3 ? 1.0F : 0.0F};
}

bool counts_light(const Channel& channel) {
  return !channel.analyser || channel.analyser->i > 0;
}

bool behind_polariser(const Channel& channel) {
  return channel.analyser && counts_light(channel) && channel.weight.integral() != 0;
}

// True if two weights are proportional.
bool of_one_response(const Channel& a, const Channel& b) {
  constexpr double kRounding = 1e-6;
  const double factor = a.weight.integral() / b.weight.integral();
  const double largest = std::max(std::abs(a.weight.max()), std::abs(a.weight.min()));
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    if (std::abs(a.weight(nm) - factor * b.weight(nm)) > kRounding * largest) return false;
  return true;
}
}  // namespace

std::string stokes_plane_name(int component, std::string_view channel) {
  return fmt::format("{}{}", kPrefixes.at(static_cast<std::size_t>(component)), channel);
}

std::vector<Channel> with_stokes(std::vector<Channel> channels) {
  const std::size_t count = channels.size();
  for (int component = 1; component < 4; ++component)
    for (std::size_t k = 0; k < count; ++k) {
      Channel channel = channels[k];
      channel.name = stokes_plane_name(component, channel.name);
      channel.analyser = analyser_of(component);
      channels.push_back(std::move(channel));
    }
  return channels;
}

std::size_t count_intensities(std::span<const Channel> channels) {
  return static_cast<std::size_t>(std::count_if(channels.begin(), channels.end(), counts_light));
}

std::vector<Channel> intensities(std::span<const Channel> channels) {
  std::vector<Channel> selected;
  std::copy_if(channels.begin(), channels.end(), std::back_inserter(selected), counts_light);
  return selected;
}

std::vector<std::string> intensities(std::span<const std::string> planes) {
  std::vector<std::string> selected;
  std::copy_if(planes.begin(), planes.end(), std::back_inserter(selected), [](const std::string& name) {
    return std::none_of(kPrefixes.begin() + 1, kPrefixes.end(),
                        [&](std::string_view prefix) { return name.starts_with(prefix); });
  });
  return selected;
}

bool any_analyser(std::span<const Channel> channels) {
  return std::ranges::any_of(channels, [](const Channel& c) { return c.analyser.has_value(); });
}

std::vector<std::optional<PolariserRow>> polariser_rows(std::span<const Channel> channels) {
  std::vector<std::optional<PolariserRow>> rows;
  for (const Channel& channel : channels) {
    rows.emplace_back();
    if (!behind_polariser(channel)) continue;
    const auto first = std::find_if(channels.begin(), channels.end(), [&channel](const Channel& other) {
      return behind_polariser(other) && of_one_response(channel, other);
    });
    const double integral = channel.weight.integral();
    const double contrast = integral_of_product(channel.weight, channel.analyser->contrast) / integral;
    rows.back() = PolariserRow{first->name, integral / first->weight.integral(),
                               contrast * static_cast<double>(channel.analyser->q),
                               contrast * static_cast<double>(channel.analyser->u)};
  }
  return rows;
}

std::string to_text(const PolariserRow& row) {
  return fmt::format("{} {} {} {}", row.group, row.weight, row.q, row.u);
}

std::optional<PolariserRow> parse_polariser_row(std::string_view text) {
  const std::vector<std::string> words = split(std::string(text), ' ');
  if (words.size() != 4) return std::nullopt;
  const auto weight = parse_number(words[1]);
  const auto q = parse_number(words[2]);
  const auto u = parse_number(words[3]);
  if (!weight || !(*weight > 0) || !q || !u) return std::nullopt;
  return PolariserRow{words[0], *weight, *q, *u};
}

}  // namespace abbe
