#include "calibration/chart/measured_patches.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "io/error.h"
#include "io/table.h"
#include "io/text.h"

namespace abbe {
namespace {

constexpr const char* kDiffuser = "perfect diffuser";
constexpr double kNeutralChroma = 5;

// Cells of the named columns of every row; nothing when one is missing or no number.
std::optional<std::vector<std::array<double, 3>>> triples(const Table& table,
                                                          const std::array<const char*, 3>& columns,
                                                          Diagnostics& diagnostics) {
  std::vector<std::array<double, 3>> rows(table.rows.size());
  for (std::size_t k = 0; k < 3; ++k) {
    const auto column = table.column(columns[k]);
    if (!column) {
      diagnostics.error(table.where, fmt::format("no column \"{}\"", columns[k]), ErrorCode::input);
      return std::nullopt;
    }
    const auto numbers = table.numbers(*column, diagnostics);
    if (!numbers) return std::nullopt;
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i][k] = (*numbers)[i];
  }
  return rows;
}

std::optional<std::vector<std::string>> patch_names(const Table& table, Diagnostics& diagnostics) {
  const auto column = table.column("patch");
  if (!column) {
    diagnostics.error(table.where, "no column \"patch\"", ErrorCode::input);
    return std::nullopt;
  }
  std::vector<std::string> names;
  for (const std::vector<std::string>& row : table.rows) names.push_back(row[*column]);
  return names;
}

// Whether no patch was measured twice, which of the values would count being anyone's guess.
bool each_once(const std::vector<std::string>& names, const Table& table, Diagnostics& diagnostics) {
  std::set<std::string_view> seen;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!seen.insert(names[i]).second)
      diagnostics.error(table.position(i), fmt::format("patch \"{}\" is named twice", names[i]),
                        ErrorCode::input);
  return seen.size() == names.size();
}

XYZ from_xyy(const std::array<double, 3>& c) {
  return {c[0] / c[1] * c[2], c[2], (1 - c[0] - c[1]) / c[1] * c[2]};
}

std::optional<ChartTargets> stated_colors(const Table& table, Diagnostics& diagnostics) {
  const auto key = table.keys.find("white_xy");
  std::vector<double> xy;
  if (key != table.keys.end())
    for (const std::string& piece : split(key->second, ',')) xy.push_back(parse_number(piece).value_or(0));
  if (xy.size() != 2 || !(xy[0] > 0 && xy[1] > 0)) {
    diagnostics.error(table.where,
                      "neither wavelengths nor a line \"# white_xy: x, y\" of two chromaticity coordinates",
                      ErrorCode::input);
    return std::nullopt;
  }
  auto names = patch_names(table, diagnostics);
  const bool is_lab = table.column("L").has_value();
  const auto values =
      is_lab ? triples(table, {"L", "a", "b"}, diagnostics) : triples(table, {"x", "y", "Y"}, diagnostics);
  if (!names || !values) return std::nullopt;
  ChartTargets colors{*std::move(names), {}, from_xyy({xy[0], xy[1], 1})};
  for (const std::array<double, 3>& c : *values)
    colors.xyz.push_back(is_lab ? lab_to_xyz(c, colors.white) : from_xyy(c));
  return colors;
}

bool is_neutral(const XYZ& xyz, const XYZ& white) {
  const Lab lab = xyz_to_lab(xyz, white);
  return std::hypot(lab[1], lab[2]) < kNeutralChroma;
}

}  // namespace

std::optional<ChartTargets> load_chart_targets(const std::string& name, const Curve& illuminant,
                                               const SourcePosition& where, Diagnostics& diagnostics) {
  const std::optional<Table> table = read_chart_table(name, where, diagnostics);
  if (!table) return std::nullopt;
  if (!is_spectral(*table)) return stated_colors(*table, diagnostics);
  const std::optional<Chart> chart = load_chart(name, where, diagnostics);
  if (!chart) return std::nullopt;
  ChartTargets colors{{}, {}, unit_tristimulus(illuminant, Curve(1.0))};
  for (const Patch& patch : chart->patches) {
    colors.names.push_back(patch.name);
    colors.xyz.push_back(unit_tristimulus(illuminant, patch.reflectance));
  }
  return colors;
}

std::optional<MeasuredPatches> load_measured_patches(const std::filesystem::path& path,
                                                     Diagnostics& diagnostics) {
  const std::optional<Table> table = read_table(path, TableOrigin::user, diagnostics);
  if (!table) return std::nullopt;
  auto names = patch_names(*table, diagnostics);
  auto values = triples(*table, {"R", "G", "B"}, diagnostics);
  if (!names || !values || !each_once(*names, *table, diagnostics)) return std::nullopt;
  return MeasuredPatches{*std::move(names), *std::move(values)};
}

BalancedPatches balance(const ChartTargets& chart, const MeasuredPatches& measured) {
  const auto find = [&](const std::string& name) -> const Raw* {
    const auto found = std::find(measured.names.begin(), measured.names.end(), name);
    return found == measured.names.end()
               ? nullptr
               : &measured.values[static_cast<std::size_t>(found - measured.names.begin())];
  };
  BalancedPatches balanced{{chart.names, {}, chart.xyz, chart.white}, {}};
  std::vector<std::string> missing;
  Raw neutral{};
  double weight = 0;
  for (std::size_t i = 0; i < chart.names.size(); ++i) {
    const Raw* const raw = find(chart.names[i]);
    if (raw == nullptr) {
      missing.push_back(chart.names[i]);
      continue;
    }
    balanced.colors.raw.push_back(*raw);
    if (!is_neutral(chart.xyz[i], chart.white)) continue;
    const double y = chart.xyz[i][1];
    for (std::size_t k = 0; k < 3; ++k) neutral[k] += (*raw)[k] * y;
    weight += y * y;
  }
  if (!missing.empty())
    throw Error(ErrorCode::input, "measured patches", fmt::format("missing: {}", fmt::join(missing, ", ")));
  const Raw* const diffuser = find(kDiffuser);
  for (std::size_t k = 0; k < 3; ++k) {
    const double white = diffuser != nullptr ? (*diffuser)[k] : neutral[k] / weight;
    if (!(std::isfinite(white) && white > 0))
      throw Error(
          ErrorCode::input, "measured patches",
          fmt::format("nothing to balance white on: neither a row \"{}\" nor neutral patches", kDiffuser));
    balanced.gains[k] = 1 / white;
    for (Raw& raw : balanced.colors.raw) raw[k] /= white;
  }
  return balanced;
}

}  // namespace abbe
