#include "sensor/response/polariser_group.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/text.h"
#include "sensor/response/stokes_channels.h"

namespace abbe {
namespace {

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
