#include "spectral/chart.h"

#include "io/table.h"
#include "spectral/library.h"

namespace abbe {

std::optional<Chart> load_chart(const std::string& name, const SourcePosition& where,
                                Diagnostics& diagnostics) {
  const std::optional<TableColumn> found = find_table("reflectance", name, where, diagnostics);
  if (!found) return std::nullopt;
  const TableOrigin origin = name.ends_with(".csv") ? TableOrigin::user : TableOrigin::shipped;
  const std::optional<Table> table = read_table(found->path, origin, diagnostics);
  if (!table) return std::nullopt;
  Chart chart{name, {}};
  for (const std::string& column : table->columns) {
    if (column.starts_with("wavelength")) continue;
    const std::optional<NamedCurve> curve =
        load_curve("reflectance", name + ":" + column, where, diagnostics);
    if (!curve) return std::nullopt;
    chart.patches.push_back({column, curve->curve});
  }
  return chart;
}

}  // namespace abbe
