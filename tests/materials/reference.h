#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "io/table.h"
#include "io/text.h"
#include "materials/index/library.h"

namespace abbe {

/// A table of known answers, row by row.
class Reference {
 public:
  explicit Reference(const std::string& file) {
    Diagnostics diagnostics;
    if (auto table = read_table(std::string(ABBE_REFERENCE "/") + file, TableOrigin::shipped, diagnostics))
      table_ = *std::move(table);
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.text();
  }
  [[nodiscard]] std::size_t rows() const { return table_.rows.size(); }
  [[nodiscard]] const std::string& text(std::size_t row, const std::string& column) const {
    return table_.rows.at(row).at(table_.column(column).value());
  }
  [[nodiscard]] double number(std::size_t row, const std::string& column) const {
    return parse_number(text(row, column)).value();
  }

 private:
  Table table_;
};

/// The material of that name, which must load without complaint.
inline RefractiveIndex index_of(const std::string& name) {
  Diagnostics diagnostics;
  const auto named = load_index(name, {}, diagnostics);
  EXPECT_TRUE(named && diagnostics.all().empty()) << name << ": " << diagnostics.text();
  return named ? named->index : RefractiveIndex(1.0);
}

}  // namespace abbe
