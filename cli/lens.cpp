#include "cli/lens.h"

#include <array>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/lens_answer.h"
#include "cli/output_files.h"
#include "description/lens_files.h"
#include "io/atomic_file.h"
#include "io/extension.h"
#include "report/lens_drawing.h"

namespace abbe::cli {
namespace {

lens::System load(const LensOptions& options, Inputs& inputs) {
  Diagnostics diagnostics;
  return accepted(load_lens(options.lens, diagnostics, &inputs, {}, options.wavelengths_nm), diagnostics);
}

// Transposed table with a line per column.
std::string transposed(const Json& columns) {
  std::string lines;
  for (const auto& [name, values] : columns.items()) {
    lines += fmt::format("{:<22}", name);
    for (const Json& value : values)
      lines += fmt::format("  {:>12}", value.is_string() ? value.get<std::string>()
                                       : value.is_null() ? "-"
                                                         : value.dump());
    lines += '\n';
  }
  return lines;
}

void print_tables(const LensFigures& figures) {
  const LensTables tables = lens_tables(figures);
  fmt::print("{}\n{}\n{}\n{}\nbrightest ghosts\n{}", text(tables.whole, false),
             transposed(tables.wavelengths), text(tables.surfaces, false), text(tables.fields, false),
             text(tables.ghosts, false));
}

}  // namespace

int lens(const LensOptions& options) {
  if (!options.html.empty()) require_extension(options.html, {".html"});
  if (!options.drawing.empty()) require_extension(options.drawing, {".svg"});
  Inputs inputs;
  const lens::System system = load(options, inputs);
  require_distinct(std::array{options.html, options.drawing}, inputs.files());
  const LensFigures figures = lens_figures(system, {.frequencies_per_mm = options.frequencies_per_mm});
  if (!options.html.empty()) write_atomically(options.html, lens_page(figures));
  if (!options.drawing.empty()) write_atomically(options.drawing, lens_drawing(figures));
  if (options.json)
    print(lens_answer(figures), true);
  else
    print_tables(figures);
  return 0;
}

}  // namespace abbe::cli
