#include "calibration/chart/measured_patches.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "io/error.h"
#include "io/picture_codec.h"
#include "io/table.h"
#include "io/text.h"
#include "sensor/film/patch.h"
#include "sensor/film/recorded_attributes.h"
#include "spectral/curve_use.h"

namespace abbe {
namespace {

// Numbers in the named columns of every row; empty if a column is missing or a cell is not a number.
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

bool are_unique(const std::vector<std::string>& names, const Table& table, Diagnostics& diagnostics) {
  std::set<std::string_view> unique;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!unique.insert(names[i]).second)
      diagnostics.error(table.position(i), fmt::format("patch \"{}\" is named twice", names[i]),
                        ErrorCode::input);
  return unique.size() == names.size();
}

constexpr std::array kDeviations{"R_deviation", "G_deviation", "B_deviation"};
constexpr std::array kPixels{"R_pixels", "G_pixels", "B_pixels"};

// True for an empty cell, and for the 0 of one pixel, which has no scatter and must not count as exact.
bool is_unknown(const std::string& deviation, double pixels) {
  return deviation.empty() || (pixels == 1 && parse_number(deviation) == 0.0);
}

bool is_noise_unknown(const Table& table, const MeasuredPatches& patches, const std::vector<Raw>& pixels,
                      Diagnostics& diagnostics) {
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t column = table.column(kDeviations[k]).value();
      if (patches.saturated.contains(patches.names[i]) || !is_unknown(table.rows[i][column], pixels[i][k]))
        continue;
      diagnostics.warning(table.position(i),
                          fmt::format("patch \"{}\" has no {}, as one pixel gives none: all patches get "
                                      "equal weights; show the chart on more pixels",
                                      patches.names[i], kDeviations[k]));
      return true;
    }
  return false;
}

std::optional<std::vector<Raw>> pixel_deviations(Table table, Diagnostics& diagnostics) {
  for (const char* name : kDeviations)
    if (const auto column = table.column(name))
      for (std::vector<std::string>& row : table.rows)
        if (row[*column].empty()) row[*column] = "0";
  return triples(table, kDeviations, diagnostics);
}

// Deviations of the means over the pixels of each patch; an empty list if one of a patch in use is unknown.
std::optional<std::vector<Raw>> deviations_of_means(const Table& table, const MeasuredPatches& patches,
                                                    std::vector<Raw> deviations,
                                                    const std::vector<Raw>& pixels,
                                                    Diagnostics& diagnostics) {
  if (deviations.empty()) return deviations;
  for (std::size_t i = 0; i < deviations.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(deviations[i][k] >= 0 && pixels[i][k] >= 1))
        diagnostics.error(table.position(i), "expected deviations of 0 or more and 1 pixel or more",
                          ErrorCode::input);
      deviations[i][k] /= std::sqrt(pixels[i][k]);
    }
  if (diagnostics.has_errors()) return std::nullopt;
  return is_noise_unknown(table, patches, pixels, diagnostics) ? std::vector<Raw>{} : deviations;
}

// True if more pixels are saturated than may be defective. A value below 1 is a fraction of the pixels, which
// counts if it is above 0.
bool is_too_bright(double saturated, double pixels) {
  return saturated >= 1 ? exceeds_defects(saturated, pixels) : saturated > 0;
}

// Patches at the highest value of a channel without deviation, if all others have a deviation. The camera
// clips them, although a table without columns of saturated pixels does not record it.
std::set<std::string> noiseless_maxima(const Table& table, const MeasuredPatches& patches,
                                       const std::vector<Raw>& deviations, const std::vector<Raw>& pixels,
                                       Diagnostics& diagnostics) {
  constexpr double kMinPixels = 16;  // fewer pixels may be equal by chance
  const auto& names = patches.names;
  std::set<std::string> noiseless;
  if (deviations.empty()) return noiseless;
  for (std::size_t k = 0; k < 3; ++k) {
    double top = 0;
    for (const Raw& value : patches.values) top = std::max(top, value[k]);
    std::size_t noisy = 0;
    std::vector<std::size_t> clipped;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (deviations[i][k] > 0)
        ++noisy;
      else if (patches.values[i][k] == top && pixels[i][k] >= kMinPixels)
        clipped.push_back(i);
    if (noisy == 0 || noisy + clipped.size() < names.size()) continue;
    for (const std::size_t i : clipped)
      if (noiseless.insert(names[i]).second)
        diagnostics.warning(table.position(i),
                            fmt::format("patch \"{}\" has the highest value of {} in all its pixels, without "
                                        "the noise of others: it counts as clipped and is excluded",
                                        names[i], std::array{"R", "G", "B"}.at(k)));
  }
  return noiseless;
}

// Patches with more saturated pixels than may be defective, with a warning for each. Without columns of
// pixels, which are 0 then, any saturated pixel counts.
std::set<std::string> saturated_in(const Table& table, const std::vector<std::string>& names,
                                   const std::vector<Raw>& pixels, Diagnostics& diagnostics) {
  std::set<std::string> saturated;
  const auto counts = triples(table, {"R_saturated", "G_saturated", "B_saturated"}, diagnostics);
  for (std::size_t i = 0; counts && i < names.size(); ++i) {
    bool is_saturated = false;
    for (std::size_t k = 0; k < 3; ++k)
      is_saturated = is_saturated || is_too_bright((*counts)[i][k], pixels[i][k]);
    if (!is_saturated) continue;
    saturated.insert(names[i]);
    diagnostics.warning(
        table.position(i),
        fmt::format("patch \"{}\" has saturated pixels, so its values are too low: it is excluded; expose "
                    "less, or show it on more pixels if defective ones exceed {:g} % of it",
                    names[i], 100 * kMaxDefectiveFraction));
  }
  return saturated;
}

// XYZ of x, y, Y; black for Y = 0, whatever x and y are.
XYZ from_xyy(const std::array<double, 3>& c) {
  if (c[2] == 0) return {};
  return {c[0] / c[1] * c[2], c[2], (1 - c[0] - c[1]) / c[1] * c[2]};
}

std::optional<std::string> color_fault(const std::array<double, 3>& c, bool is_lab, const XYZ& xyz) {
  const bool is_finite = std::isfinite(xyz[0]) && std::isfinite(xyz[1]) && std::isfinite(xyz[2]);
  if (!is_finite || !(is_lab || c[1] > 0 || c[2] == 0))
    return fmt::format("states no colour (got {:g}, {:g}, {:g}, allowed {})", c[0], c[1], c[2],
                       is_lab ? "L, a, b of finite X, Y, Z" : "y above 0 or a Y of 0, and finite X, Y, Z");
  const double highest = kReflectanceFactorUse.allowed.high;
  if (xyz[1] <= highest) return std::nullopt;
  return fmt::format(
      "has another scale (got a Y of {:g}, allowed {:g} at most: Y of the perfect diffuser is 1)", xyz[1],
      highest);
}

std::optional<std::vector<XYZ>> stated_rows(const Table& table, const XYZ& white, Diagnostics& diagnostics) {
  const bool is_lab = table.column("L").has_value();
  const auto values =
      is_lab ? triples(table, {"L", "a", "b"}, diagnostics) : triples(table, {"x", "y", "Y"}, diagnostics);
  if (!values) return std::nullopt;
  std::vector<XYZ> colors;
  for (const std::array<double, 3>& c : *values) {
    const XYZ xyz = is_lab ? lab_to_xyz(c, white) : from_xyy(c);
    if (auto fault = color_fault(c, is_lab, xyz))
      diagnostics.error(table.position(colors.size()), *std::move(fault), ErrorCode::input);
    colors.push_back(xyz);
  }
  return diagnostics.has_errors() ? std::nullopt : std::optional(std::move(colors));
}

std::optional<ChartTargets> stated_colors(const Table& table, Diagnostics& diagnostics) {
  std::vector<double> xy;
  for (const std::string& piece : split(attribute_of(table.keys, "white_xy").value_or(""), ','))
    xy.push_back(parse_number(piece).value_or(0));
  if (xy.size() != 2 || !(xy[0] > 0 && xy[1] > 0)) {
    diagnostics.error(table.where,
                      "neither wavelengths nor a line \"# white_xy: x, y\" of two chromaticity coordinates",
                      ErrorCode::input);
    return std::nullopt;
  }
  auto names = patch_names(table, diagnostics);
  const XYZ white = from_xyy({xy[0], xy[1], 1});
  auto xyz = stated_rows(table, white, diagnostics);
  if (!names || !xyz) return std::nullopt;
  return ChartTargets{*std::move(names), *std::move(xyz), white};
}

// Full scale of values in a unit; 1 for fractions of it.
double full_scale_of(const std::string& unit, const FullScale& full_scale) {
  if (unit == kNumbersAboveBlack) return full_scale.dn.value();
  return unit == kCodeValues || unit == kFilmValues ? full_scale.value : 1;
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

void warn_of_codes(const std::filesystem::path& file, const std::string& instead, Diagnostics& diagnostics) {
  const auto source = std::make_shared<const SourceText>(SourceText{file.string(), ""});
  diagnostics.warning({source, SourcePosition::kWholeFile, ""},
                      "its values are code values of a picture and count as linear, but code values for "
                      "displays are not linear: " +
                          instead);
}

void warn_unless_linear(const Image& picture, const std::filesystem::path& file, const std::string& instead,
                        Diagnostics& diagnostics) {
  if (attribute_of(picture.metadata, kColorSpace) != kLinear) warn_of_codes(file, instead, diagnostics);
}

std::optional<MeasuredPatches> load_measured_patches(const std::filesystem::path& path,
                                                     Diagnostics& diagnostics) {
  const std::optional<Table> table = read_table(path, TableOrigin::user, diagnostics);
  if (!table) return std::nullopt;
  auto names = patch_names(*table, diagnostics);
  auto values = triples(*table, {"R", "G", "B"}, diagnostics);
  if (!names || !values || !are_unique(*names, *table, diagnostics)) return std::nullopt;
  MeasuredPatches patches{*std::move(names), *std::move(values)};
  patches.unit = attribute_of(table->keys, "unit").value_or("");
  const bool has_noise = table->column(kDeviations[0]).has_value();
  const bool counts_saturated = table->column("R_saturated").has_value();
  const auto pixels = has_noise || (counts_saturated && table->column(kPixels[0]))
                          ? triples(*table, kPixels, diagnostics)
                          : std::vector<Raw>(patches.names.size());
  const auto of_pixels = has_noise ? pixel_deviations(*table, diagnostics) : std::vector<Raw>{};
  if (!pixels || !of_pixels) return std::nullopt;
  patches.saturated = counts_saturated ? saturated_in(*table, patches.names, *pixels, diagnostics)
                                       : noiseless_maxima(*table, patches, *of_pixels, *pixels, diagnostics);
  auto deviations = deviations_of_means(*table, patches, *of_pixels, *pixels, diagnostics);
  if (!deviations) return std::nullopt;
  patches.deviations = *std::move(deviations);
  return patches;
}

void scale_to_codes(MeasuredPatches& patches, const FullScale& full_scale,
                    const std::filesystem::path& file) {
  if (patches.unit == kNumbersAboveBlack && !full_scale.dn)
    throw Error(ErrorCode::input, file.string(),
                fmt::format("its values are {}, for which the series records no full scale: give values from "
                            "0 to 1 at full scale",
                            kNumbersAboveBlack));
  const double full = full_scale_of(patches.unit, full_scale);
  for (std::size_t i = 0; i < patches.values.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      patches.values[i][k] /= full;
      if (!patches.deviations.empty()) patches.deviations[i][k] /= full;
      if (patches.values[i][k] > 1 && !patches.saturated.contains(patches.names[i]))
        throw Error(
            ErrorCode::input, file.string(),
            fmt::format(
                "patch \"{}\" has a value of {} (allowed 0 to 1 at full scale, the range of the response)",
                patches.names[i], patches.values[i][k]));
    }
}

}  // namespace abbe
