#include "sensor/readout/readout_json.h"

#include <algorithm>

#include "io/object_reader.h"

namespace abbe {
namespace {

constexpr Range kElectrons{0, 1e12};
constexpr Range kGain{0, 1e9, true, false};
constexpr int kMostBits = 16;  // as the files that hold raw data

std::optional<MonotoneCurve> read_response_curve(const JsonValue& json, Diagnostics& diagnostics) {
  const auto* array = std::get_if<JsonValue::Array>(&json.value);
  std::vector<MonotoneCurve::Point> points;
  for (const JsonValue& point : array ? *array : JsonValue::Array{}) {
    const auto pair = read_numbers(point, 2, Range::unit(), diagnostics);
    if (!pair) return std::nullopt;
    points.push_back({pair->front(), pair->back()});
  }
  const auto falls = [](const auto& a, const auto& b) { return !(a.in < b.in && a.out < b.out); };
  const auto is = [](const MonotoneCurve::Point& p, double x) { return p.in == x && p.out == x; };
  if (points.size() >= 2 && is(points.front(), 0) && is(points.back(), 1) &&
      std::adjacent_find(points.begin(), points.end(), falls) == points.end())
    return MonotoneCurve(std::move(points));
  diagnostics.error(json.where, "expected points [in, out] that increase in both, from [0, 0] to [1, 1]");
  return std::nullopt;
}

}  // namespace

std::optional<Readout> read_readout(const JsonValue& json, Diagnostics& diagnostics) {
  ObjectReader reader(json, diagnostics);
  Readout readout;
  readout.gain_e_per_dn = reader.require_number("gain_e_per_dn", kGain).value_or(readout.gain_e_per_dn);
  if (const JsonValue* bits = reader.require("bits"))
    readout.bits = static_cast<int>(read_integer(*bits, {1, kMostBits}, diagnostics).value_or(readout.bits));
  readout.offset_dn = reader.number_or("offset_dn", 0, {0, readout.highest_code(), false, true});
  readout.full_well_e =
      reader.number_or("full_well_e", readout.full_well_e, {0, kElectrons.high, true, false});
  readout.read_noise_e = reader.number_or("read_noise_e", 0, kElectrons);
  readout.dark_e_per_s = reader.number_or("dark_e_per_s", 0, kElectrons);
  readout.prnu_percent = reader.number_or("prnu_percent", 0, {0, 100});
  readout.dsnu_e = reader.number_or("dsnu_e", 0, kElectrons);
  if (const auto n = reader.integer("serial", {0, 9007199254740992.0}))
    readout.serial = static_cast<std::uint64_t>(*n);
  if (const JsonValue* curve = reader.find("response_curve"))
    readout.response_curve = read_response_curve(*curve, diagnostics);
  reader.finish();
  return diagnostics.has_errors() ? std::nullopt : std::optional(std::move(readout));
}

}  // namespace abbe
