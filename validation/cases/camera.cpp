#include <fmt/format.h>

#include "calibration/chart/patches.h"
#include "calibration/fit/correction.h"
#include "io/reference_table.h"
#include "validation/cases/figures.h"
#include "validation/cases/suites.h"
#include "validation/cases/tables.h"

namespace abbe {
namespace {

// Row 0 of a chart is the perfect diffuser.
Curve patch_of(const std::string& spectra, std::size_t index) {
  return index == 0 ? Curve(1.0) : shipped_chart(spectra).patches.at(index - 1).reflectance;
}

std::vector<Figure> raw_values() {
  const ReferenceTable table("camera_raw_colorchecker");
  std::vector<Figure> figures;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& name = table.text(row, "camera");
    const std::string& light = table.text(row, "illuminant");
    const std::vector<Channel> channels = shipped_camera(name);
    const std::vector<double> raw = camera_raw(
        channels, shipped_illuminant(light),
        patch_of(table.text(row, "spectra"), static_cast<std::size_t>(table.number(row, "index"))));
    for (std::size_t k = 0; k < raw.size(); ++k)
      figures.push_back(
          exact_figure(fmt::format("{} {} {} {}", name, light, table.text(row, "patch"), channels[k].name),
                       table.number(row, "raw_" + channels[k].name), raw[k]));
  }
  return figures;
}

struct Fitted {
  std::string name;
  PatchColors colors;
  Matrix3 matrix;
};
Fitted fit_row(const ReferenceTable& table, std::size_t row) {
  const std::string& camera = table.text(row, "camera");
  const std::string& spectra = table.text(row, "spectra");
  const std::string& light = table.text(row, "illuminant");
  PatchColors colors =
      integrate(shipped_chart(spectra), shipped_camera(camera), shipped_illuminant(light), kVisibleRange);
  const Matrix3 matrix = least_squares_matrix(colors);
  return {fmt::format("{} {} {}", camera, light, spectra), std::move(colors), matrix};
}

std::vector<Figure> least_squares_matrices() {
  const ReferenceTable table("camera_least_squares_matrix");
  std::vector<Figure> figures;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const Fitted fitted = fit_row(table, row);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const std::string entry = fmt::format("m{}{}", i + 1, j + 1);
        figures.push_back(
            exact_figure(fitted.name + " " + entry, table.number(row, entry), fitted.matrix[i][j]));
      }
  }
  return figures;
}

std::vector<Figure> least_squares_differences() {
  const ReferenceTable table("camera_least_squares_matrix");
  std::vector<Figure> figures;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const Fitted fitted = fit_row(table, row);
    const PatchErrors errors = patch_errors(fitted.colors, linear_correction(fitted.matrix));
    figures.push_back(exact_figure(fitted.name + " mean", table.number(row, "dE00_mean"), errors.mean));
    figures.push_back(exact_figure(fitted.name + " max", table.number(row, "dE00_max"), errors.max));
  }
  return figures;
}

}  // namespace

std::vector<Case> camera_cases() {
  const std::string source = "linear least squares over measured spectra [Pascale2012], [Ohta1997]";
  return {
      computed_case(Suite::camera, "raw", "raw values of a measured camera for the ColorChecker",
                    "sums over measured sensitivities and spectra [Pascale2012], [Ohta1997]", "", {5.1e-8},
                    raw_values),
      computed_case(Suite::camera, "least-squares", "least-squares matrices of a measured camera", source, "",
                    {1e-6}, least_squares_matrices),
      computed_case(Suite::camera, "least-squares-dE", "residual colour differences of those matrices",
                    source, "ΔE", {5.1e-5}, least_squares_differences),
  };
}

}  // namespace abbe
