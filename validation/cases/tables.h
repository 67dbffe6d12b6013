#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/error.h"
#include "io/table.h"
#include "materials/index/library.h"
#include "sensor/response/channel.h"
#include "spectral/chart.h"
#include "spectral/colorimetry.h"
#include "spectral/library.h"
#include "validation/cases/case.h"

namespace abbe {

/// Row of a table of known answers. Both functions throw Error{input} for a missing column.
struct ReferenceRow {
  const ReferenceTable& table;
  std::size_t index;

  [[nodiscard]] const std::string& text(std::string_view column) const { return table.text(index, column); }
  [[nodiscard]] double number(std::string_view column) const { return table.number(index, column); }
};

/// Figures that `add(figures, row)` appends for each row of a table of `data/reference`.
template <typename Add>
[[nodiscard]] Figures figures_of_rows(const std::string& table_name, Add add) {
  const ReferenceTable table(table_name);
  Figures figures;
  for (std::size_t row = 0; row < table.rows(); ++row) add(figures, ReferenceRow{table, row});
  return figures;
}

/// Value that a loader of shipped data returned. Throws Error{input} with the loader's diagnostics if there
/// is none.
template <typename T>
[[nodiscard]] T shipped(std::optional<T> value, const Diagnostics& diagnostics) {
  if (!value) throw Error(ErrorCode::input, "", diagnostics.text());
  return *std::move(value);
}

/// Observer of a field of view in degrees: CIE 1931 for "2", CIE 1964 for any other text.
[[nodiscard]] inline Observer observer(const std::string& degrees) {
  return degrees == "2" ? Observer::cie1931 : Observer::cie1964;
}

/// Shipped data by name. These functions throw Error{input} if the name is unknown or the table is
/// malformed.
[[nodiscard]] inline RefractiveIndex shipped_index(const std::string& name) {
  Diagnostics diagnostics;
  return shipped(load_index(name, {}, diagnostics), diagnostics).index;
}
[[nodiscard]] inline Curve shipped_illuminant(const std::string& name) {
  Diagnostics diagnostics;
  return shipped(load_illuminant(name, {}, diagnostics), diagnostics).curve;
}
[[nodiscard]] inline std::vector<Channel> shipped_camera(const std::string& name) {
  Diagnostics diagnostics;
  return shipped(load_camera(name, {}, diagnostics), diagnostics);
}

}  // namespace abbe
