#include "sensor/response/camera_json.h"

#include <fmt/format.h>

#include "io/json.h"
#include "io/json_values.h"
#include "io/text.h"

namespace abbe {
namespace {

constexpr const char* kUnit = "relative";

// Member at the end of a path of keys. Reports a missing key.
const JsonValue* descend(const JsonValue& root, std::initializer_list<const char*> keys,
                         Diagnostics& diagnostics) {
  const JsonValue* value = &root;
  for (const char* key : keys) {
    const JsonValue* const inner = value->find(key);
    if (inner == nullptr) {
      diagnostics.error(value->where, fmt::format("missing key \"{}\"", key), ErrorCode::input);
      return nullptr;
    }
    value = inner;
  }
  return value;
}

std::vector<std::string> channel_names(const JsonValue& main, Diagnostics& diagnostics) {
  std::vector<std::string> names;
  if (const auto* const list = std::get_if<JsonValue::Array>(&main.value))
    for (const JsonValue& name : *list) names.push_back(read_string(name, diagnostics).value_or(""));
  if (names.empty()) diagnostics.error(main.where, "expected the names of the channels", ErrorCode::input);
  return names;
}

struct CameraSamples {
  std::vector<double> wavelengths_nm;
  std::vector<std::vector<double>> values;  // one list per channel
};

CameraSamples samples_of(const JsonValue& main, std::size_t channels, Diagnostics& diagnostics) {
  CameraSamples samples{{}, std::vector<std::vector<double>>(channels)};
  const auto* const rows = std::get_if<JsonValue::Object>(&main.value);
  if (rows == nullptr || rows->size() < 2) {
    diagnostics.error(main.where, "expected two wavelengths or more, each with its values", ErrorCode::input);
    return samples;
  }
  for (const auto& [key, row] : *rows) {
    const double nm = parse_number(key).value_or(0);
    const double last = samples.wavelengths_nm.empty() ? 0 : samples.wavelengths_nm.back();
    if (!(nm >= kMinWavelengthNm && nm <= kMaxWavelengthNm && nm > last))
      diagnostics.error(row.key_position(),
                        fmt::format("got wavelength {}, allowed ascending numbers of nm in [{}, {}]", key,
                                    kMinWavelengthNm, kMaxWavelengthNm),
                        ErrorCode::input);
    samples.wavelengths_nm.push_back(nm);
    const auto values = read_numbers(row, channels, Range::any(), diagnostics);
    for (std::size_t k = 0; values && k < channels; ++k) samples.values[k].push_back((*values)[k]);
  }
  return samples;
}

}  // namespace

std::optional<std::vector<NamedCurve>> read_camera_json(const std::filesystem::path& path,
                                                        Diagnostics& diagnostics) {
  const std::size_t before = diagnostics.all().size();
  const auto source = read_text(path, diagnostics);
  if (!source) return std::nullopt;
  const std::optional<JsonValue> root = parse_json(source, diagnostics);
  if (!root) return std::nullopt;
  const JsonValue* const units = descend(*root, {"spectral_data", "units"}, diagnostics);
  const JsonValue* const index = descend(*root, {"spectral_data", "index", "main"}, diagnostics);
  const JsonValue* const data = descend(*root, {"spectral_data", "data", "main"}, diagnostics);
  if (units == nullptr || index == nullptr || data == nullptr) return std::nullopt;
  static_cast<void>(read_choice(*units, "unit", {kUnit}, diagnostics));
  const std::vector<std::string> names = channel_names(*index, diagnostics);
  const CameraSamples samples = samples_of(*data, names.size(), diagnostics);
  if (diagnostics.all().size() != before) return std::nullopt;
  const std::vector<double>& nm = samples.wavelengths_nm;
  std::vector<NamedCurve> curves;
  for (std::size_t k = 0; k < names.size(); ++k)
    curves.push_back({names[k], path.string(), kUnit, nm.front(), nm.back(),
                      table_curve(nm, samples.values[k], Outside::zero)});
  return curves;
}

}  // namespace abbe
