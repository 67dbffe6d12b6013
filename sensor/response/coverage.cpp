#include "sensor/response/coverage.h"

#include <algorithm>

#include <fmt/format.h>

namespace abbe {
namespace {

/// The share of what is counted that lies beyond the rows of a table, and by whom.
struct LostShare {
  double share = 0;
  std::string counter;
};

LostShare most_lost(const NamedCurve& table, const Curve& light, std::span<const Counter> counters) {
  LostShare most;
  for (const Counter& counter : counters) {
    const double share = share_beyond(*counter.weight, light, table.low_nm, table.high_nm).share;
    if (share > most.share) most = {share, counter.name};
  }
  return most;
}

}  // namespace

NeededRange needed_by(std::span<const Channel> channels) {
  NeededRange needed;
  for (const Channel& channel : channels) {
    const NeededRange own = main_range(channel.weight);
    needed = {std::min(needed.low_nm, own.low_nm), std::max(needed.high_nm, own.high_nm)};
  }
  return needed;
}

std::vector<Counter> counters_of(std::span<const Channel> channels) {
  std::vector<Counter> counters;
  for (const Channel& channel : channels)
    counters.push_back({fmt::format("channel \"{}\"", channel.name), &channel.weight});
  return counters;
}

bool check_ends(const NamedCurve& table, const Curve& light, std::span<const Channel> channels,
                const SourcePosition& where, Diagnostics& diagnostics) {
  return check_ends(table, light, counters_of(channels), where, diagnostics);
}

bool check_ends(const NamedCurve& table, const Curve& light, std::span<const Counter> counters,
                const SourcePosition& where, Diagnostics& diagnostics) {
  if (table.outside == Outside::clamp) return true;
  const auto [share, counter] = most_lost(table, light, counters);
  if (!(share > kNegligibleShare)) return true;
  if (table.outside == Outside::zero) {
    diagnostics.warning(
        where,
        fmt::format(
            "\"{}\" is 0 beyond its table, {:g} to {:g} nm: {:.3g} % of what {} "
            "would count, if it went on as it ends, lies there; a row of 0 at its end says that it does not",
            table.name, table.low_nm, table.high_nm, 100 * share, counter));
    return true;
  }
  diagnostics.error(where,
                    fmt::format("\"{}\" covers {:g} to {:g} nm only, where {:.3g} % of what {} "
                                "counts is not (a line \"# outside: clamp\" or \"# outside: zero\" says what "
                                "holds there)",
                                table.name, table.low_nm, table.high_nm, 100 * share, counter),
                    ErrorCode::input);
  return false;
}

bool check_ends_of_light(const NamedCurve& light, std::span<const Channel> channels,
                         const SourcePosition& where, Diagnostics& diagnostics) {
  return check_ends(light, held_beyond(light), channels, where, diagnostics);
}

}  // namespace abbe
