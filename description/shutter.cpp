#include "description/shutter.h"

#include <cstddef>

#include <fmt/format.h>

#include "description/kinds.h"

namespace abbe::spec {

using namespace schema;

Fields fields(Tag<Shutter>) {
  constexpr Range kSeconds = Range{0, 1e9}.in("s");
  constexpr Range kShare{0, 1};
  using Knot = std::array<double, 2>;
  return describe(
      "shutter", "When the rows of the sensor are open to light, and how far; each is for `exposure_s`.",
      {defaulted("open_s", &Shutter::open_s, Range{-1e9, 1e9}.in("s"),
                 "When the first row opens, on the clock of keyframes."),
       defaulted("rise_s", &Shutter::rise_s, kSeconds, "How long it takes to open, at a constant rate."),
       defaulted("fall_s", &Shutter::fall_s, kSeconds, "How long it takes to close."),
       field("transmission", &Shutter::transmission, list<Knot>(vector<Knot>(kShare), "pairs", 2),
             "In place of both: pairs of the share of `exposure_s` that has gone by, from 0 to 1, and the "
             "share of the light that passes then, with straight lines between them."),
       defaulted("row_delay_s", &Shutter::row_delay_s, kSeconds,
                 "By how much each row opens later than that above it, as in a rolling shutter.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

std::vector<Shutter::Knot> knots_of(const schema::Located<std::vector<std::array<double, 2>>>& said,
                                    const LoadContext& context) {
  std::vector<Shutter::Knot> knots;
  double passing = 0;
  for (const auto& [at, passes] : said.value) {
    if (!knots.empty() && at < knots.back().at) {
      context.diagnostics.error(
          said.where, fmt::format("shares of the exposure increase (got {} after {})", at, knots.back().at));
      return {};
    }
    if (!knots.empty()) passing += (at - knots.back().at) * (passes + knots.back().passes);
    knots.push_back({at, passes});
  }
  if (knots.front().at == 0 && knots.back().at == 1 && passing > 0) return knots;
  context.diagnostics.error(said.where,
                            fmt::format("a transmission goes from 0 to 1, and passes some light (got one "
                                        "from {} to {} that passes {:g} in the mean)",
                                        knots.front().at, knots.back().at, passing / 2));
  return {};
}

}  // namespace

Shutter build(const spec::Shutter& said, double exposure_s, int rows, const LoadContext& context) {
  std::vector<Shutter::Knot> knots;
  const double moving_s = said.rise_s + said.fall_s;
  if (said.transmission && moving_s > 0)
    context.diagnostics.error(said.transmission->where,
                              "a shutter has one shape: rise_s and fall_s, or transmission");
  else if (said.transmission)
    knots = knots_of(*said.transmission, context);
  else if (moving_s > exposure_s)
    context.diagnostics.error(said.where,
                              fmt::format("a shutter opens and closes within the exposure time (got {} s, "
                                          "allowed up to {} s)",
                                          moving_s, exposure_s));
  else
    knots = {{0, said.rise_s > 0 ? 0.0 : 1.0},
             {said.rise_s / exposure_s, 1},
             {1 - said.fall_s / exposure_s, 1},
             {1, said.fall_s > 0 ? 0.0 : 1.0}};
  if (knots.empty()) return {};
  return Shutter(std::move(knots), said.row_delay_s / exposure_s, rows);
}

}  // namespace abbe::description
