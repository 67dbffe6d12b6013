#include "sensor/response/table_range.h"

#include <algorithm>

#include <fmt/format.h>

namespace abbe {

NeededRange needed_by(std::span<const Channel> channels) {
  NeededRange needed;
  for (const Channel& channel : channels) {
    const NeededRange own = main_range(channel.weight);
    needed = {std::min(needed.low_nm, own.low_nm), std::max(needed.high_nm, own.high_nm)};
  }
  return needed;
}

std::vector<NamedResponse> named_responses(std::span<const Channel> channels) {
  std::vector<NamedResponse> responses;
  for (const Channel& channel : channels)
    responses.push_back({fmt::format("channel \"{}\"", channel.name), &channel.weight});
  return responses;
}

bool check_table_range(const NamedCurve& table, const Curve& light, std::span<const NamedResponse> responses,
                       const SourcePosition& where, Diagnostics& diagnostics) {
  if (table.outside == Outside::clamp) return true;
  double fraction = 0;
  std::string response;  // the one that loses most
  for (const auto& [name, weight] : responses) {
    const double lost = fraction_outside(*weight, light, table.low_nm, table.high_nm).fraction;
    if (lost > fraction) response = name;
    fraction = std::max(fraction, lost);
  }
  if (!(fraction > kNegligibleFraction)) return true;
  if (table.outside == Outside::zero) {
    diagnostics.warning(
        where,
        fmt::format("\"{}\" is 0 outside its table, {:g} to {:g} nm: {:.3g} % of the integral for {} would "
                    "lie there with constant extrapolation; end the table with a row of 0 if it falls to 0",
                    table.name, table.low_nm, table.high_nm, 100 * fraction, response));
    return true;
  }
  diagnostics.error(
      where,
      fmt::format("\"{}\" covers only {:g} to {:g} nm, but {:.3g} % of the integral for {} lies outside (add "
                  "a line \"# outside: clamp\" or \"# outside: zero\" to extrapolate)",
                  table.name, table.low_nm, table.high_nm, 100 * fraction, response),
      ErrorCode::input);
  return false;
}

bool check_light_range(const NamedCurve& light, std::span<const Channel> channels,
                       const SourcePosition& where, Diagnostics& diagnostics) {
  return check_table_range(light, extrapolated(light), named_responses(channels), where, diagnostics);
}

}  // namespace abbe
