#include "sensor/readout/readout_json.h"

#include <algorithm>

#include <fmt/format.h>

#include "io/schema/read.h"

namespace abbe {
namespace {

constexpr Range kElectrons = Range{0, 1e12}.in("electrons");
constexpr Range kHeldElectrons{0, kElectrons.high, true, false, kElectrons.measured_in};
constexpr Range kGain{0, 1e9, true, false, "electrons per digital number"};
constexpr int kMostBits = 16;  // as the files that hold raw data

std::optional<MonotoneCurve> build_curve(const schema::Located<std::vector<std::array<double, 2>>>& said,
                                         Diagnostics& diagnostics) {
  std::vector<MonotoneCurve::Point> points;
  for (const auto& [in, out] : said.value) points.push_back({in, out});
  const auto falls = [](const auto& a, const auto& b) { return !(a.in < b.in && a.out < b.out); };
  const auto is = [](const MonotoneCurve::Point& p, double x) { return p.in == x && p.out == x; };
  if (points.size() >= 2 && is(points.front(), 0) && is(points.back(), 1) &&
      std::adjacent_find(points.begin(), points.end(), falls) == points.end())
    return MonotoneCurve(std::move(points));
  diagnostics.error(said.where, "expected points [in, out] that increase in both, from [0, 0] to [1, 1]");
  return std::nullopt;
}

}  // namespace

static schema::Fields fields(schema::Tag<Readout>) {
  using namespace schema;
  return describe(
      "readout_numbers", "",
      {field("gain_e_per_dn", &Readout::gain_e_per_dn, kGain, "Conversion gain K."),
       field("bits", &Readout::bits, {1, kMostBits}, "Bits of the codes."),
       defaulted("full_well_e", &Readout::full_well_e, kHeldElectrons,
                 "Electrons a pixel holds, unlimited when absent."),
       defaulted("read_noise_e", &Readout::read_noise_e, kElectrons, "Standard deviation of the read noise."),
       defaulted("dark_e_per_s", &Readout::dark_e_per_s, kElectrons.in("electrons per s"),
                 "Mean dark current."),
       defaulted("prnu_percent", &Readout::prnu_percent, Range{0, 100}.in("%"),
                 "Standard deviation of the pixels' sensitivities, of their mean."),
       defaulted("dsnu_e", &Readout::dsnu_e, kElectrons, "Standard deviation of the pixels' offsets."),
       defaulted("serial", &Readout::serial, {0, kLargestInteger},
                 "Which specimen of the sensor: it fixes the patterns of PRNU and DSNU, the same in every "
                 "exposure.")});
}

schema::Fields spec::fields(schema::Tag<Readout>) {
  using namespace schema;
  using Point = std::array<double, 2>;
  return describe("readout", "How electrons become digital numbers, for channels that count electrons.",
                  {lent(&Readout::numbers),
                   defaulted("offset_dn", &Readout::offset_dn, {0, 65535, false, true},
                             "Code of a pixel without electrons, less than 2^bits - 1."),
                   field("response_curve", &Readout::response_curve,
                         list<Point>(vector<Point>(Range::unit()), "points [in, out]", 0),
                         "Points [signal, code] in shares of the codes above the offset, linear between "
                         "them, increasing from [0, 0] to [1, 1]; a straight line when absent.")});
}

std::optional<Readout> build(const spec::Readout& said, Diagnostics& diagnostics) {
  Readout readout;  // assigned, since GCC 12 takes the curve of a copy for uninitialised
  readout = said.numbers;
  readout.offset_dn = said.offset_dn.value;
  if (said.response_curve) readout.response_curve = build_curve(*said.response_curve, diagnostics);
  const Range codes{0, readout.highest_code(), false, true};
  if (!codes.contains(readout.offset_dn))
    diagnostics.error(said.offset_dn.where,
                      fmt::format("expected a number (got {}, allowed {})", readout.offset_dn, codes.text()));
  else if (!said.response_curve || readout.response_curve)
    return readout;
  return std::nullopt;
}

std::optional<Readout> read_readout(const JsonValue& json, Diagnostics& diagnostics) {
  const auto readout = schema::read<spec::Readout>(json, diagnostics);
  return readout ? build(*readout, diagnostics) : std::nullopt;
}

}  // namespace abbe
