#include "spectral/chart.h"

#include <utility>

#include <fmt/format.h>

#include "io/error.h"
#include "spectral/library.h"

namespace abbe {

std::optional<Table> read_chart_table(const std::string& name, const SourcePosition& where,
                                      Diagnostics& diagnostics) {
  const std::optional<TableColumn> location = find_table("reflectance", name, where, diagnostics);
  if (!location) return std::nullopt;
  const TableOrigin origin = user_table_end(name) == name.size() ? TableOrigin::user : TableOrigin::shipped;
  return read_table(location->path, origin, diagnostics);
}

bool is_spectral(const Table& table) {
  return !table.columns.empty() && table.columns.front().starts_with("wavelength");
}

std::optional<Chart> load_chart(const std::string& name, const SourcePosition& where,
                                Diagnostics& diagnostics, const CurveUse& use, NeededRange needed) {
  const std::optional<Table> table = read_chart_table(name, where, diagnostics);
  if (!table) return std::nullopt;
  if (!is_spectral(*table))
    return diagnostics.refuse(table->where,
                              "contains colours, but camera values can be computed only from reflectances",
                              ErrorCode::input);
  if (auto fault = unit_fault(name, table->provenance.unit, use.unit))
    return diagnostics.refuse(where, *std::move(fault), ErrorCode::input);
  Chart chart{name, {}};
  for (const std::string& column : table->columns) {
    if (column.starts_with("wavelength")) continue;
    const std::optional<NamedCurve> curve =
        load_curve(use.folder, name + ":" + column, where, diagnostics, needed);
    if (!curve) return std::nullopt;
    const Curve& values = curve->curve;
    if (!use.allowed.contains(values.min()) || !use.allowed.contains(values.max()))
      return diagnostics.refuse(
          where,
          fmt::format("patch \"{}\" is no reflectance (got values in [{}, {}], allowed {})", column,
                      values.min(), values.max(), use.allowed.text()),
          ErrorCode::input);
    chart.patches.push_back({column, values});
  }
  return chart;
}

Chart shipped_chart(const std::string& name) {
  Diagnostics diagnostics;
  std::optional<Chart> chart = load_chart(name, {}, diagnostics);
  if (!chart) throw Error(diagnostics.code(), name, diagnostics.text());
  return *std::move(chart);
}

}  // namespace abbe
