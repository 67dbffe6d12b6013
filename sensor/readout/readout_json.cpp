#include "sensor/readout/readout_json.h"

#include <algorithm>

#include <fmt/format.h>

#include "io/schema/read.h"
#include "sensor/readout/speed.h"

namespace abbe {
namespace {

constexpr Range kElectrons = Range{0, 1e12}.in("electrons");
constexpr Range kFullWell{0, kElectrons.high, true, false, kElectrons.unit_name};
constexpr Range kGain{0, 1e9, true, false, "electrons per digital number"};
constexpr Range kSpeed{0, 1e9, true, false};
constexpr int kMaxBits = 16;  // the limit of raw files

std::optional<MonotoneCurve> build_curve(const schema::Located<std::vector<std::array<double, 2>>>& spec,
                                         Diagnostics& diagnostics) {
  std::vector<MonotoneCurve::Point> points;
  for (const auto& [in, out] : spec.value) points.push_back({in, out});
  const auto falls = [](const auto& a, const auto& b) { return !(a.in < b.in && a.out < b.out); };
  const auto is = [](const MonotoneCurve::Point& p, double x) { return p.in == x && p.out == x; };
  if (points.size() >= 2 && is(points.front(), 0) && is(points.back(), 1) &&
      std::adjacent_find(points.begin(), points.end(), falls) == points.end())
    return MonotoneCurve(std::move(points));
  diagnostics.error(spec.where, "expected points [in, out] that increase in both, from [0, 0] to [1, 1]");
  return std::nullopt;
}

}  // namespace

static schema::Fields fields(schema::Tag<Readout>) {
  using namespace schema;
  return describe(
      "readout_numbers", "",
      {defaulted("full_well_e", &Readout::full_well_e, kFullWell,
                 "Full-well capacity in electrons, unlimited if absent."),
       defaulted("read_noise_e", &Readout::read_noise_e, kElectrons, "Standard deviation of the read noise."),
       defaulted(
           "row_noise_e", &Readout::row_noise_e, kElectrons,
           "Standard deviation of the noise common to all pixels of a row, independent in each exposure."),
       defaulted("dark_e_per_s", &Readout::dark_e_per_s, kElectrons.in("electrons per s"),
                 "Mean dark current."),
       defaulted("prnu_percent", &Readout::prnu_percent, Range{0, 100}.in("%"),
                 "Standard deviation of the pixels' sensitivities, relative to their mean."),
       defaulted("dsnu_e", &Readout::dsnu_e, kElectrons, "Standard deviation of the pixels' offsets."),
       defaulted("hot_pixels_percent", &Readout::hot_pixels_percent, Range{0, 100}.in("%"),
                 "Percentage of pixels with an additional dark current."),
       defaulted("hot_pixel_e_per_s", &Readout::hot_pixel_e_per_s, kElectrons.in("electrons per s"),
                 "Mean of the additional dark current of hot pixels, which is exponentially distributed."),
       defaulted("blooming", &Readout::blooming,
                 "True if the excess charge of a full well flows along its column."),
       defaulted("serial", &Readout::serial, {0, kLargestInteger},
                 "Number of the sensor specimen; it selects PRNU, DSNU and the hot pixels, which are the "
                 "same in every exposure.")});
}

schema::Fields spec::fields(schema::Tag<Readout>) {
  using namespace schema;
  using Point = std::array<double, 2>;
  return describe(
      "readout", "How electrons become digital numbers, for channels that count electrons.",
      {at_most_one(&Readout::conversion, "a gain or an ISO speed",
                   under<Gain>("gain_e_per_dn", kGain,
                               "Conversion gain K, required unless `iso` or the model gives it."),
                   under<IsoSpeed>(
                       "iso", kSpeed,
                       "Saturation-based ISO speed that determines the gain, instead of `gain_e_per_dn`.")),
       field("bits", &Readout::bits, {1, kMaxBits}, "Bits of the codes, required here or in the model."),
       inlined(&Readout::numbers),
       field("saturation_dn", &Readout::saturation_dn, {0, 65535, true, false},
             "Highest code, 2^bits - 1 if absent."),
       defaulted("offset_dn", &Readout::offset_dn, {0, 65535, false, true},
                 "Code of a pixel without electrons, less than 2^bits - 1."),
       field("response_curve", &Readout::response_curve,
             list<Point>(vector<Point>(Range::unit()), "points [in, out]", 0),
             "Points [signal, code] in fractions of the codes above the offset, linear between "
             "them, increasing from [0, 0] to [1, 1]; a straight line if absent.")});
}

namespace {

// Gain that gives a speed, or nothing if the sensor cannot have it.
std::optional<double> gain_of(const spec::IsoSpeed& iso, const Readout& readout,
                              std::optional<double> sensitivity, Diagnostics& diagnostics) {
  if (!sensitivity) {
    diagnostics.error(iso.where,
                      "a speed requires the sensitivity of the sensor in electrons, which is unknown");
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

// Reports missing keys after the model has supplied its own.
bool check_complete(const spec::Readout& spec, Diagnostics& diagnostics) {
  if (!spec.bits) diagnostics.error(spec.where, "missing key \"bits\"");
  const bool converts = !std::holds_alternative<std::monostate>(spec.conversion);
  if (!converts) diagnostics.error(spec.where, "missing key \"gain_e_per_dn\" or \"iso\"");
  return spec.bits && converts;
}

// True if offset and saturation leave codes between them; otherwise reports them.
bool check_codes(const spec::Readout& spec, const Readout& readout, Diagnostics& diagnostics) {
  const double largest = static_cast<double>((1U << readout.bits) - 1);
  if (spec.saturation_dn && spec.saturation_dn->value > largest)
    diagnostics.error(spec.saturation_dn->where,
                      fmt::format("no code of {} bits (got {}, allowed up to {})", readout.bits,
                                  spec.saturation_dn->value, largest));
  else if (const Range codes{0, readout.highest_code(), false, true}; !codes.contains(readout.offset_dn))
    diagnostics.error(spec.offset_dn.where,
                      fmt::format("expected a number (got {}, allowed {})", readout.offset_dn, codes.text()));
  else
    return true;
  return false;
}

}  // namespace

std::optional<Readout> build(const spec::Readout& spec, std::optional<double> sensitivity,
                             Diagnostics& diagnostics) {
  Readout readout;  // assigned, because GCC 12 warns of an uninitialised curve in a copy
  readout = spec.numbers;
  readout.bits = spec.bits.value_or(readout.bits);
  readout.offset_dn = spec.offset_dn.value;
  if (spec.saturation_dn) readout.saturation_dn = spec.saturation_dn->value;
  if (spec.response_curve) readout.response_curve = build_curve(*spec.response_curve, diagnostics);
  if (!check_complete(spec, diagnostics)) return std::nullopt;
  if (!check_codes(spec, readout, diagnostics) || (spec.response_curve && !readout.response_curve))
    return std::nullopt;
  std::optional<double> gain;
  if (const auto* stated = std::get_if<spec::Gain>(&spec.conversion)) gain = stated->value;
  if (const auto* iso = std::get_if<spec::IsoSpeed>(&spec.conversion))
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
