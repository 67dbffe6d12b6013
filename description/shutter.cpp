#include "description/shutter.h"

#include <cstddef>

#include <fmt/format.h>

#include "description/value_ranges.h"

namespace abbe::spec {

using namespace schema;

Fields fields(Tag<Shutter>) {
  constexpr Range kSeconds = Range{0, 1e9}.in("s");
  constexpr Range kFraction{0, 1};
  using Knot = std::array<double, 2>;
  return describe(
      "shutter", "Times and transmission of the rows of the sensor; each row is open for `exposure_s`.",
      {defaulted("open_s", &Shutter::open_s, Range{-1e9, 1e9}.in("s"),
                 "Time at which the first row opens, on the clock of keyframes."),
       defaulted("rise_s", &Shutter::rise_s, kSeconds, "Time to open, at a constant rate."),
       defaulted("fall_s", &Shutter::fall_s, kSeconds, "Time to close, at a constant rate."),
       field("transmission", &Shutter::transmission, list<Knot>(vector<Knot>(kFraction), "pairs", 2),
             "Replaces both: pairs of the elapsed fraction of `exposure_s`, from 0 to 1, and the "
             "transmittance at that time, linearly interpolated."),
       defaulted("row_delay_s", &Shutter::row_delay_s, kSeconds,
                 "Delay of each row after the row above it, as in a rolling shutter.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

std::vector<Shutter::Knot> knots_of(const schema::Located<std::vector<std::array<double, 2>>>& spec,
                                    const LoadContext& context) {
  std::vector<Shutter::Knot> knots;
  double transmitted = 0;
  for (const auto& [at, passes] : spec.value) {
    if (!knots.empty() && at < knots.back().time) {
      context.diagnostics.error(
          spec.where, fmt::format("fractions of the exposure time must increase (got {} after {})", at,
                                  knots.back().time));
      return {};
    }
    if (!knots.empty()) transmitted += (at - knots.back().time) * (passes + knots.back().transmittance);
    knots.push_back({at, passes});
  }
  if (knots.front().time == 0 && knots.back().time == 1 && transmitted > 0) return knots;
  context.diagnostics.error(
      spec.where,
      fmt::format(
          "a transmission must run from 0 to 1 and pass some light (got one from {} to {} with mean {:g})",
          knots.front().time, knots.back().time, transmitted / 2));
  return {};
}

}  // namespace

Shutter build(const spec::Shutter& spec, double exposure_s, int rows, const LoadContext& context) {
  std::vector<Shutter::Knot> knots;
  const double moving_s = spec.rise_s + spec.fall_s;
  if (spec.transmission && moving_s > 0)
    context.diagnostics.error(spec.transmission->where,
                              "a shutter has either rise_s and fall_s, or transmission");
  else if (spec.transmission)
    knots = knots_of(*spec.transmission, context);
  else if (moving_s > exposure_s)
    context.diagnostics.error(
        spec.where,
        fmt::format("a shutter must open and close within the exposure time (got {} s, allowed up to {} s)",
                    moving_s, exposure_s));
  else
    knots = {{0, spec.rise_s > 0 ? 0.0 : 1.0},
             {spec.rise_s / exposure_s, 1},
             {1 - spec.fall_s / exposure_s, 1},
             {1, spec.fall_s > 0 ? 0.0 : 1.0}};
  if (knots.empty()) return {};
  return Shutter(std::move(knots), spec.row_delay_s / exposure_s, rows);
}

}  // namespace abbe::description
