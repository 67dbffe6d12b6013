#include "description/curve.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "description/values.h"
#include "spectral/library.h"
#include "spectral/sources.h"

namespace abbe::description {
namespace {

// Wavelengths of a table's samples: wide enough for tables beyond the rendered range, too high for
// micrometres.
constexpr Range kTableWavelength{100, 1e5};
constexpr Range kLineWidth{1e-3, kMaxWavelengthNm - kMinWavelengthNm};

std::optional<Curve> read_any(const JsonValue& json, std::string_view folder, LoadContext& context);

std::optional<Outside> read_outside(ObjectReader& reader, LoadContext& context) {
  const JsonValue* json = reader.require("outside");
  if (!json) return std::nullopt;
  const auto choice =
      read_choice(*json, "rule for outside the table", {"clamp", "zero"}, context.diagnostics);
  if (!choice) return std::nullopt;
  return *choice == 0 ? Outside::clamp : Outside::zero;
}

std::optional<Curve> read_table_curve(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const auto wavelengths = reader.require_numbers("wavelength_nm", 0, kTableWavelength);
  const auto values = reader.require_numbers("values", 0, kValue);
  const std::optional<Outside> outside = read_outside(reader, context);
  reader.finish();
  if (!wavelengths || !values || !outside) return std::nullopt;
  if (values->size() != wavelengths->size()) {
    context.diagnostics.error(
        json.where, fmt::format("as many values as wavelengths are needed (got {} values, allowed {})",
                                values->size(), wavelengths->size()));
    return std::nullopt;
  }
  if (wavelengths->size() < 2) {
    context.diagnostics.error(json.where,
                              fmt::format("a table needs two samples or more (got {})", wavelengths->size()));
    return std::nullopt;
  }
  const auto step = std::adjacent_find(wavelengths->begin(), wavelengths->end(), std::greater_equal<>());
  if (step != wavelengths->end()) {
    context.diagnostics.error(
        json.where, fmt::format("wavelengths must ascend (got {} nm after {} nm)", *(step + 1), *step));
    return std::nullopt;
  }
  return table_curve(*wavelengths, *values, *outside);
}

std::optional<Curve> read_band(const JsonValue& json, double value, LoadContext& context) {
  const auto ends = read_numbers(json, 2, kWavelength, context.diagnostics);
  if (!ends) return std::nullopt;
  const double low = (*ends)[0];
  const double high = (*ends)[1];
  if (low < high) return band(low, high, value);
  context.diagnostics.error(json.where,
                            fmt::format("an empty band (got [{}, {}] nm, allowed low < high)", low, high));
  return std::nullopt;
}

std::optional<Curve> read_gaussian(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const auto center = reader.require_number("center_nm", kWavelength);
  const auto width = reader.require_number("fwhm_nm", kLineWidth);
  const double peak = reader.number_or("peak", 1, kValue);
  reader.finish();
  if (!center || !width) return std::nullopt;
  return gaussian(*center, *width, peak);
}

std::optional<Curve> read_lines(const JsonValue& json, LoadContext& context) {
  const JsonValue::Array* list = read_array(json, "lines", 1, context.diagnostics);
  if (!list) return std::nullopt;
  std::vector<SpectralLine> found;
  for (const JsonValue& entry : *list) {
    ObjectReader reader(entry, context.diagnostics);
    const auto center = reader.require_number("nm", kWavelength);
    const auto width = reader.require_number("width_nm", kLineWidth);
    const auto power = reader.require_number("power", kPower);
    reader.finish();
    if (center && width && power) found.push_back({*center, *width, *power});
  }
  if (found.size() != list->size()) return std::nullopt;
  return lines(found);
}

// A product or a sum of one curve or more.
template <typename Combine>
std::optional<Curve> read_list(const JsonValue& json, std::string_view folder, LoadContext& context,
                               Combine combine) {
  const JsonValue::Array* list = read_array(json, "curves", 1, context.diagnostics);
  if (!list) return std::nullopt;
  std::optional<Curve> all;
  bool complete = true;
  for (const JsonValue& entry : *list) {
    std::optional<Curve> one = read_any(entry, folder, context);
    complete = complete && one;
    if (complete) all = all ? combine(*all, *one) : std::move(one);
  }
  return complete ? all : std::nullopt;
}

std::optional<Curve> read_scaled(ObjectReader& reader, std::string_view folder, LoadContext& context) {
  const std::optional<double> factor = reader.require_number("scale", kValue);
  const std::optional<Curve> curve = read_any(*reader.find("of"), folder, context);
  if (!factor || !curve) return std::nullopt;
  return scaled(*curve, *factor);
}

std::optional<Curve> read_object(const JsonValue& json, std::string_view folder, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const auto key = reader.exactly_one(
      {"table", "band", "gaussian", "lines", "blackbody_K", "daylight_K", "product", "sum", "of"});
  if (!key) return std::nullopt;
  const JsonValue& of = *reader.find(*key);
  std::optional<Curve> curve;
  if (*key == "table") {
    curve = read_table_curve(of, context);
  } else if (*key == "band") {
    curve = read_band(of, reader.number_or("value", 1, kValue), context);
  } else if (*key == "gaussian") {
    curve = read_gaussian(of, context);
  } else if (*key == "product") {
    curve = read_list(of, folder, context, product);
  } else if (*key == "sum") {
    curve = read_list(of, folder, context, [](const Curve& a, const Curve& b) { return sum(a, b); });
  } else if (*key == "of") {
    curve = read_scaled(reader, folder, context);
  } else {
    curve = read_source(*key, of, context);
  }
  reader.finish();
  return curve;
}

std::optional<Curve> read_named(const JsonValue& json, std::string_view folder, LoadContext& context) {
  const std::optional<std::string> name = context.table(json);
  if (!name) return std::nullopt;
  std::optional<NamedCurve> named = load_curve(folder, *name, json.where, context.diagnostics);
  if (!named) return std::nullopt;
  return std::move(named->curve);
}

std::optional<Curve> read_any(const JsonValue& json, std::string_view folder, LoadContext& context) {
  if (std::holds_alternative<std::string>(json.value)) return read_named(json, folder, context);
  if (std::holds_alternative<JsonValue::Object>(json.value)) return read_object(json, folder, context);
  if (std::holds_alternative<double>(json.value)) {
    const std::optional<double> value = read_number(json, kValue, context.diagnostics);
    return value ? std::optional(Curve(*value)) : std::nullopt;
  }
  context.diagnostics.error(
      json.where, fmt::format("expected a curve: a number, a name or an object (got {})", json.kind()));
  return std::nullopt;
}

}  // namespace

std::optional<Curve> read_source(std::string_view key, const JsonValue& json, LoadContext& context) {
  if (key == "lines") return read_lines(json, context);
  const bool day = key == "daylight_K";
  const auto temperature = read_number(json, day ? Range{4000, 25000} : Range{100, 1e6}, context.diagnostics);
  if (!temperature) return std::nullopt;
  return day ? daylight(*temperature) : planck(*temperature);
}

std::optional<Curve> read_curve(const JsonValue& json, const CurveUse& use, LoadContext& context) {
  std::optional<Curve> curve = read_any(json, use.folder, context);
  if (!curve) return std::nullopt;
  const auto fault = value_fault(*curve, use.allowed);
  if (!fault) return curve;
  context.diagnostics.error(json.where, *fault);
  return std::nullopt;
}

}  // namespace abbe::description
