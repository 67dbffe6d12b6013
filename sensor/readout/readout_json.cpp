#include "sensor/readout/readout_json.h"

#include <algorithm>

#include <fmt/format.h>

#include "io/schema/read.h"
#include "sensor/readout/speed.h"

namespace abbe {
namespace {

constexpr Range kElectrons = Range{0, 1e12}.in("electrons");
constexpr Range kHeldElectrons{0, kElectrons.high, true, false, kElectrons.measured_in};
constexpr Range kGain{0, 1e9, true, false, "electrons per digital number"};
constexpr Range kSpeed{0, 1e9, true, false};
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
      {defaulted("full_well_e", &Readout::full_well_e, kHeldElectrons,
                 "Electrons a pixel holds, unlimited when absent."),
       defaulted("read_noise_e", &Readout::read_noise_e, kElectrons, "Standard deviation of the read noise."),
       defaulted("row_noise_e", &Readout::row_noise_e, kElectrons,
                 "Standard deviation of what all pixels of a row have in common, anew in each exposure."),
       defaulted("dark_e_per_s", &Readout::dark_e_per_s, kElectrons.in("electrons per s"),
                 "Mean dark current."),
       defaulted("prnu_percent", &Readout::prnu_percent, Range{0, 100}.in("%"),
                 "Standard deviation of the pixels' sensitivities, of their mean."),
       defaulted("dsnu_e", &Readout::dsnu_e, kElectrons, "Standard deviation of the pixels' offsets."),
       defaulted("hot_pixels_percent", &Readout::hot_pixels_percent, Range{0, 100}.in("%"),
                 "Share of pixels with a dark current of their own."),
       defaulted("hot_pixel_e_per_s", &Readout::hot_pixel_e_per_s, kElectrons.in("electrons per s"),
                 "Mean of the hot pixels' own dark currents, which are exponentially distributed."),
       defaulted("blooming", &Readout::blooming,
                 "Whether the electrons that a full well cannot hold flow along its column."),
       defaulted("serial", &Readout::serial, {0, kLargestInteger},
                 "Which specimen of the sensor: it fixes PRNU, DSNU and the hot pixels, the same in every "
                 "exposure.")});
}

schema::Fields spec::fields(schema::Tag<Readout>) {
  using namespace schema;
  using Point = std::array<double, 2>;
  return describe(
      "readout", "How electrons become digital numbers, for channels that count electrons.",
      {at_most_one(&Readout::conversion, "a gain or a speed that stands for one",
                   under<Gain>("gain_e_per_dn", kGain,
                               "Conversion gain K, needed unless `iso` or the model says it."),
                   under<IsoSpeed>("iso", kSpeed,
                                   "In place of the gain: the saturation-based ISO speed that it gives.")),
       field("bits", &Readout::bits, {1, kMostBits}, "Bits of the codes, needed here or in the model."),
       lent(&Readout::numbers),
       field("saturation_dn", &Readout::saturation_dn, {0, 65535, true, false},
             "Highest code, 2^bits - 1 when absent."),
       defaulted("offset_dn", &Readout::offset_dn, {0, 65535, false, true},
                 "Code of a pixel without electrons, less than 2^bits - 1."),
       field("response_curve", &Readout::response_curve,
             list<Point>(vector<Point>(Range::unit()), "points [in, out]", 0),
             "Points [signal, code] in shares of the codes above the offset, linear between "
             "them, increasing from [0, 0] to [1, 1]; a straight line when absent.")});
}

namespace {

// The gain that a speed asks for; nothing where the sensor cannot have it.
std::optional<double> gain_of(const spec::IsoSpeed& iso, const Readout& readout,
                              std::optional<double> sensitivity, Diagnostics& diagnostics) {
  if (!sensitivity) {
    diagnostics.error(iso.where, "the speed of a sensor whose sensitivity in electrons is not known");
    return std::nullopt;
  }
  Readout tried = readout;
  tried.gain_e_per_dn = gain_of_speed(readout, iso.value, *sensitivity);
  const double speed = saturation_speed(tried, *sensitivity);
  if (speed <= iso.value * (1 + 1e-9)) return tried.gain_e_per_dn;
  diagnostics.error(iso.where,
                    fmt::format("the well of {} electrons is full before the codes end (got ISO {}, "
                                "allowed {:.4g} and above)",
                                readout.full_well_e, iso.value, speed));
  return std::nullopt;
}

// What a model may say is not missed until it has been put in.
bool check_complete(const spec::Readout& said, Diagnostics& diagnostics) {
  if (!said.bits) diagnostics.error(said.where, "missing key \"bits\"");
  const bool converts = !std::holds_alternative<std::monostate>(said.conversion);
  if (!converts) diagnostics.error(said.where, "missing key \"gain_e_per_dn\" or \"iso\"");
  return said.bits && converts;
}

// Whether offset and saturation leave codes between them.
bool check_codes(const spec::Readout& said, const Readout& readout, Diagnostics& diagnostics) {
  const double largest = static_cast<double>((1U << readout.bits) - 1);
  if (said.saturation_dn && said.saturation_dn->value > largest)
    diagnostics.error(said.saturation_dn->where,
                      fmt::format("no code of {} bits (got {}, allowed up to {})", readout.bits,
                                  said.saturation_dn->value, largest));
  else if (const Range codes{0, readout.highest_code(), false, true}; !codes.contains(readout.offset_dn))
    diagnostics.error(said.offset_dn.where,
                      fmt::format("expected a number (got {}, allowed {})", readout.offset_dn, codes.text()));
  else
    return true;
  return false;
}

}  // namespace

std::optional<Readout> build(const spec::Readout& said, std::optional<double> sensitivity,
                             Diagnostics& diagnostics) {
  Readout readout;  // assigned, since GCC 12 takes the curve of a copy for uninitialised
  readout = said.numbers;
  readout.bits = said.bits.value_or(readout.bits);
  readout.offset_dn = said.offset_dn.value;
  if (said.saturation_dn) readout.saturation_dn = said.saturation_dn->value;
  if (said.response_curve) readout.response_curve = build_curve(*said.response_curve, diagnostics);
  if (!check_complete(said, diagnostics)) return std::nullopt;
  if (!check_codes(said, readout, diagnostics) || (said.response_curve && !readout.response_curve))
    return std::nullopt;
  std::optional<double> gain;
  if (const auto* stated = std::get_if<spec::Gain>(&said.conversion)) gain = stated->value;
  if (const auto* iso = std::get_if<spec::IsoSpeed>(&said.conversion))
    gain = gain_of(*iso, readout, sensitivity, diagnostics);
  if (!gain) return std::nullopt;
  readout.gain_e_per_dn = *gain;
  return readout;
}

std::optional<Readout> read_readout(const JsonValue& json, std::optional<double> sensitivity,
                                    Diagnostics& diagnostics) {
  const auto readout = schema::read<spec::Readout>(json, diagnostics);
  return readout ? build(*readout, sensitivity, diagnostics) : std::nullopt;
}

}  // namespace abbe
