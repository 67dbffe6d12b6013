#include <array>

#include <fmt/format.h>

#include "calibration/chart/delta_e.h"
#include "calibration/output/color_spaces.h"
#include "io/table.h"
#include "spectral/astm_e308.h"
#include "spectral/color_temperature.h"
#include "spectral/library.h"
#include "spectral/rgb.h"
#include "spectral/sources.h"
#include "validation/cases/suites.h"
#include "validation/cases/tables.h"

namespace abbe {
namespace {

// The nominal temperatures of daylight use the scale of c2 = 1.4380e-2 m K.
constexpr double kDaylightScale = 1.4388 / 1.4380;

Figures observer_sums() {
  const auto add = [](Figures& figures, const char* name, const ColorMatching& cmf,
                      const std::array<double, 3>& expected) {
    const std::array<const Curve*, 3> curves{&cmf.x, &cmf.y, &cmf.z};
    for (std::size_t i = 0; i < 3; ++i)
      figures.push_back(
          {fmt::format("{} {}", name, "xyz"[i]), expected[i], {sum_product(*curves[i], Curve(1))}});
  };
  Figures figures;
  add(figures, "1931", color_matching(Observer::cie1931), {106.865469, 106.856917, 106.892251});
  add(figures, "1964", color_matching(Observer::cie1964), {116.648519, 116.661877, 116.673981});
  return figures;
}

void add_chromaticity(Figures& figures, const std::string& name, const std::array<double, 2>& reference,
                      const XYZ& measured) {
  const std::array<double, 2> xy = chromaticity(measured);
  figures.push_back({name + " x", reference[0], {xy[0]}});
  figures.push_back({name + " y", reference[1], {xy[1]}});
}

// Chromaticities of the white points in the columns x_`kind` and y_`kind`, for rows that have them.
Figures white_points(const std::string& kind, SumRange range, Curve (*illuminant)(const std::string&)) {
  return figures_of_rows("white_points", [&](Figures& figures, const ReferenceRow& row) {
    if (row.text("x_" + kind).empty()) return;
    const std::string& degrees = row.text("observer");
    add_chromaticity(figures, fmt::format("{} {}°", row.text("illuminant"), degrees),
                     {row.number("x_" + kind), row.number("y_" + kind)},
                     tristimulus(illuminant(row.text("illuminant")), Curve(1), observer(degrees), range));
  });
}

// Illuminant outside the range of its table. D follows from its components. A follows from its definition as
// the Planckian radiator of 2848 K with c2 = 1.435e-2 m K.
Curve by_definition(const std::string& name) {
  if (name == "A") return planck(2848 * photon_energy(1) / kBoltzmann / 1.435e7);
  if (name[0] == 'D') return daylight(100 * std::stod(name.substr(1)) * kDaylightScale);
  return shipped_illuminant(name);
}

// Illuminants of the tables of ASTM E308: A by definition, daylight from its table.
Curve astm_illuminant(const std::string& name) {
  return name == "A" ? by_definition(name) : shipped_illuminant(name);
}

// Weights that ASTM E308 prints.
Figures astm_printed_weights() {
  std::string previous;
  TristimulusWeights weights{};
  return figures_of_rows("astm_e308_weights", [&](Figures& figures, const ReferenceRow& row) {
    const std::string& light = row.text("illuminant");
    const std::string& degrees = row.text("observer");
    const int step = static_cast<int>(row.number("step_nm"));
    const int nm = static_cast<int>(row.number("wavelength_nm"));
    const std::string name = fmt::format("{} {}° {} nm", light, degrees, step);
    if (name != previous) weights = astm_weights(astm_illuminant(light), observer(degrees), step, {});
    previous = name;
    const XYZ& weight = weights.weights.at(static_cast<std::size_t>((nm - weights.low_nm) / step));
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string column(1, "XYZ"[i]);
      figures.push_back({fmt::format("{} at {} nm {}", name, nm, column), row.number(column), {weight[i]}});
    }
  });
}

Figures planckian_locus() {
  return figures_of_rows("planckian", [&](Figures& figures, const ReferenceRow& row) {
    const double kelvin = row.number("T_K");
    add_chromaticity(figures, fmt::format("{} K", kelvin), {row.number("x"), row.number("y")},
                     tristimulus(planck(kelvin), Curve(1), Observer::cie1931));
  });
}

Figures planckian_radiance() {
  return figures_of_rows("planckian", [&](Figures& figures, const ReferenceRow& row) {
    for (const int nm : {400, 500, 550, 600, 700}) {
      const double kelvin = row.number("T_K");
      figures.push_back(
          {fmt::format("{} K {} nm", kelvin, nm), row.number(fmt::format("L_{}", nm)), {planck(kelvin)(nm)}});
    }
  });
}

Figures daylight_series() {
  const ReferenceTable table("cie_D_series_from_components");
  Figures figures;
  for (const std::string name : {"D50", "D55", "D65", "D75"}) {
    const Curve curve = by_definition(name);
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const double nm = table.number(row, "wavelength_nm");
      figures.push_back({fmt::format("{} {} nm", name, nm), table.number(row, name), {curve(nm)}});
    }
  }
  return figures;
}

Figures luminous_efficacies() {
  return figures_of_rows("illuminant_cct_ler", [&](Figures& figures, const ReferenceRow& row) {
    const std::string& name = row.text("illuminant");
    figures.push_back({name, row.number("LER_lm_per_W"), {luminous_efficacy(shipped_illuminant(name))}});
  });
}

// The published pairs in both orders: `formula` of the two colours against a column.
Figures sharma_pairs(const char* column, double (*formula)(const Lab&, const Lab&)) {
  return figures_of_rows("ciede2000_sharma2005", [&](Figures& figures, const ReferenceRow& row) {
    const auto lab = [&](int which) {
      return Lab{row.number(fmt::format("L{}", which)), row.number(fmt::format("a{}", which)),
                 row.number(fmt::format("b{}", which))};
    };
    const std::string pair = "pair " + row.text("pair");
    figures.push_back({pair, row.number(column), {formula(lab(1), lab(2))}});
    figures.push_back({pair + " reversed", row.number(column), {formula(lab(2), lab(1))}});
  });
}
void add_matrix(Figures& figures, const ReferenceTable& table, const std::string& name, const Matrix3& m) {
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (!table.text(row, "name").starts_with(name)) continue;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const std::string entry = fmt::format("m{}{}", i + 1, j + 1);
        figures.push_back({name + " " + entry, table.number(row, entry), {m[i][j]}});
      }
    return;
  }
  throw Error(ErrorCode::internal, name, "no such reference matrix");
}

Figures colour_matrices() {
  const ReferenceTable table("colour_matrices");
  Figures figures;
  add_matrix(figures, table, "RGB_to_XYZ sRGB", rgb_to_xyz(kRec709));
  add_matrix(figures, table, "XYZ_to_RGB sRGB", rgb_to_xyz(kRec709).inverse());
  add_matrix(figures, table, "RGB_to_XYZ ACES2065-1", rgb_to_xyz(kAces2065));
  add_matrix(figures, table, "RGB_to_XYZ ACEScg", rgb_to_xyz(kAcesCg));
  add_matrix(figures, table, "RGB_to_XYZ Display P3", rgb_to_xyz(kP3D65));
  const XYZ a = unit_xyz({0.44758, 0.40745});
  const XYZ d50 = unit_xyz({0.3457, 0.3585});
  const XYZ d65 = unit_xyz(kD65);
  add_matrix(figures, table, "Bradford adaptation A to D65", adaptation(a, d65).value());
  add_matrix(figures, table, "Bradford adaptation D50 to D65", adaptation(d50, d65).value());
  add_matrix(figures, table, "Bradford adaptation D65 to D50", adaptation(d65, d50).value());
  add_matrix(figures, table, "CAT02 adaptation A to D65", adaptation(a, d65, Adaptation::cat02).value());
  add_matrix(figures, table, "CAT02 adaptation D50 to D65", adaptation(d50, d65, Adaptation::cat02).value());
  return figures;
}

// Light and white wall of the Cornell box as Cornell measured them, with means over bands 10 nm wide.
Figures cornell_box() {
  const Curve light = shipped_illuminant("cornell_box_light");
  const Curve illuminated = product(light, shipped_curve("reflectance", "cornell_box_walls:white"));
  const auto band_mean = [&](double nm) { return illuminated.integral(nm - 5, nm + 5) / 10; };
  return {{"light", 3280, {light.integral(400, 700)}},
          {"illuminated white", 2412.5634, {illuminated.integral(400, 700)}},
          {"450 nm", 3.0273770, {band_mean(450)}},
          {"550 nm", 8.6850874, {band_mean(550)}},
          {"650 nm", 12.3558600, {band_mean(650)}}};
}

}  // namespace

std::vector<Case> colour_cases() {
  const ComputedCases computed{Suite::colour};
  const Margin millionth{1e-6};
  return {
      computed("observers", "column sums of the standard observers, 360-830 nm", "tables of [CIE15]", "",
               {0.51e-6}, observer_sums),
      computed("whites", "white points of 50 illuminants for both observers, 1 nm sums", "[CIE15, sec. 7.1]",
               "", millionth, [] { return white_points("360_830", {}, shipped_illuminant); }),
      computed("whites-truncated", "white points of illuminants, summed from 380 to 780 nm",
               "[CIE15, sec. 7.1]", "", millionth,
               [] { return white_points("1nm", kVisibleRange, shipped_illuminant); }),
      computed("astm-weights", "tristimulus weights for 10 and 20 nm as printed", "[ASTM308], [ASTM2022]", "",
               {5.01e-4}, astm_printed_weights),
      computed("whites-defined", "white points of illuminants, with A and D by definition", "[CIE15, sec. 3]",
               "", millionth, [] { return white_points("full", {}, by_definition); }),
      computed("whites-printed", "white points as printed, from rounded tables", "[CIE15, tables]", "",
               {3.5e-4}, [] { return white_points("pub", {}, shipped_illuminant); }),
      computed("locus", "chromaticities of black bodies", "Planck's law [Planck1901] and [CIE15]", "",
               millionth, planckian_locus),
      computed("planck", "spectral radiance of black bodies", "Planck's law [Planck1901]", "W/(m² sr nm)",
               {1e-7, Margin::Kind::relative}, planckian_radiance),
      computed("daylight", "CIE daylight from its components", "[CIE15, eq. 3.3]", "", {5.1e-6},
               daylight_series),
      computed("efficacy", "luminous efficacy of illuminants, 380-780 nm by trapezoids",
               "683.002 lm/W at 540 THz [CIE15]", "lm/W", {1e-4}, luminous_efficacies),
      computed("dE00", "the 34 published pairs of CIEDE2000", "[Sharma2005, table 1]", "ΔE", {5.1e-5},
               [] { return sharma_pairs("dE00", delta_e_2000<double>); }),
      computed("dE76", "the 34 pairs of CIEDE2000 by their distance in L*a*b*",
               "[Sharma2005, table 1], [CIE15, sec. 8.2.1]", "ΔE", {5.1e-5},
               [] { return sharma_pairs("dE76", delta_e_76<double>); }),
      computed("matrices", "RGB spaces and chromatic adaptation", "primaries of [BT709]; [Lam1985]", "",
               {1e-9}, colour_matrices),
      computed("cornell", "light and white wall of the Cornell box", "measured spectra [CornellBox1998]", "",
               {1e-5, Margin::Kind::relative}, cornell_box),
  };
}

}  // namespace abbe
