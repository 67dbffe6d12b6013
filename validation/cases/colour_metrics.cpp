#include <limits>

#include <fmt/format.h>

#include "calibration/metrics/appearance.h"
#include "calibration/metrics/color_rendering.h"
#include "io/table.h"
#include "spectral/color_temperature.h"
#include "spectral/interpolation.h"
#include "spectral/library.h"
#include "spectral/rgb.h"
#include "spectral/sources.h"
#include "validation/cases/suites.h"
#include "validation/cases/tables.h"

namespace abbe {
namespace {

ColorTemperature temperature_of(const Curve& light, SumRange range = {}) {
  return color_temperature(tristimulus(light, Curve(1), Observer::cie1931, range)).value();
}

// Computes a figure for each illuminant that has a value in the column.
std::function<Figures()> of_illuminants(const char* table_name, const char* column,
                                        double (*figure)(const Curve&)) {
  return [=] {
    return figures_of_rows(table_name, [&](Figures& figures, const ReferenceRow& row) {
      if (const std::string& name = row.text("illuminant"); !row.text(column).empty())
        figures.push_back({name, row.number(column), {figure(shipped_illuminant(name))}});
    });
  };
}

constexpr const char* kComputed = "illuminant_cct_ler";
constexpr const char* kPrinted = "illuminant_rendering";

// Black bodies have their own temperatures.
Figures black_body_temperatures() {
  Figures figures;
  for (const double kelvin : {1500.0, 2856.0, 6500.0, 20000.0, 50000.0, 99000.0})
    figures.push_back({fmt::format("{} K", kelvin), kelvin, {temperature_of(planck(kelvin)).kelvin}});
  return figures;
}

// The worked example of CIE 224 and FL1 are tabulated every 5 nm. The calculator sums every 5 nm; Sprague's
// rule agrees with it. One sample under FL3.9 is so near the end of the twelfth hue bin that its bin depends
// on the steps of the table of samples.
Figures fidelity_example() {
  Diagnostics diagnostics;
  const ColorFidelity example = color_fidelity(shipped_curve("reference", "cie224_example_lamp")).value();
  const ReferenceTable table("cie224_example_Rs");
  Figures figures{{"Rf", 81.6, {example.fidelity}}};
  for (std::size_t i = 0; i < table.rows(); ++i)
    figures.push_back({table.text(i, "sample"), table.number(i, "Rs"), {example.samples.at(i)}});
  const Samples fl1 = shipped(load_samples("illuminant", "FL1", {}, diagnostics), diagnostics).samples;
  const Samples fine =
      every_nanometre(fl1, Interpolation::sprague, 0, std::numeric_limits<double>::infinity());
  const Curve interpolated = table_curve(fine.wavelengths_nm, fine.values, Outside::zero);
  figures.push_back({"FL1 Rf", 80.6, {color_fidelity(interpolated).value().fidelity}});
  figures.push_back(
      {"FL3.9 Rf,h12", 71.5, {color_fidelity(shipped_illuminant("FL3.9")).value().bins[11].fidelity}});
  return figures;
}

Figures special_indices() {
  const ReferenceTable table("cri_fl1");
  const ColorRendering rendering = color_rendering(shipped_illuminant("FL1")).value();
  Figures figures;
  for (std::size_t i = 0; i < rendering.special.size(); ++i)
    figures.push_back({fmt::format("R{}", i + 1), table.number(i, "R"), {rendering.special[i]}});
  return figures;
}

Figures printed_fidelity() {
  const ColorFidelity fl2 = color_fidelity(shipped_illuminant("FL2")).value();
  Figures figures{{"Rf", 70, {fl2.fidelity}}, {"Rg", 86, {fl2.gamut}}};
  const ReferenceTable samples("tm30_fl2_samples");
  for (std::size_t i = 0; i < samples.rows(); ++i)
    figures.push_back({fmt::format("CES{:02}", i + 1), samples.number(i, "Rf"), {fl2.samples.at(i)}});
  const ReferenceTable bins("tm30_fl2_bins");
  for (std::size_t i = 0; i < bins.rows(); ++i) {
    const HueBin& bin = fl2.bins.at(i);
    const auto add = [&](const char* what, const char* column, double measured) {
      figures.push_back({fmt::format("{} of bin {}", what, i + 1), bins.number(i, column), {measured}});
    };
    add("Rf", "Rf_h", bin.fidelity);
    add("Rcs [%]", "Rcs_h_percent", 100 * bin.chroma_shift);
  }
  return figures;
}

Figures printed_hue_shifts() {
  const ColorFidelity fl2 = color_fidelity(shipped_illuminant("FL2")).value();
  const ReferenceTable bins("tm30_fl2_bins");
  Figures figures;
  for (std::size_t i = 0; i < bins.rows(); ++i)
    figures.push_back(
        {fmt::format("bin {}", i + 1), bins.number(i, "Rhs_h_rad"), {fl2.bins.at(i).hue_shift}});
  return figures;
}

Figures correlates(const char* table_name, AppearanceModel model) {
  return figures_of_rows(table_name, [&](Figures& figures, const ReferenceRow& row) {
    const auto number = [&](const char* column) { return row.number(column); };
    const Appearance appearance(
        model, {{number("Xw"), number("Yw"), number("Zw")}, number("L_A"), number("Y_b"), false});
    const ColorAppearance result = appearance(XYZ{number("X"), number("Y"), number("Z")});
    const auto add = [&](const char* what, double measured) {
      figures.push_back({fmt::format("{} of colour {}", what, row.index + 1), number(what), {measured}});
    };
    add("J", result.lightness);
    add("C", result.chroma);
    add("h", result.hue_deg);
    add("M", result.colorfulness);
  });
}

Figures printed_itp() {
  return figures_of_rows("delta_e_itp", [&](Figures& figures, const ReferenceRow& row) {
    const auto color = [&](const char* of) {
      const auto number = [&](const char* part) { return row.number(std::string(part) + of); };
      return std::array<double, 3>{number("I"), number("Ct") / 2, number("Cp")};
    };
    figures.push_back({row.text("color"), row.number("dE_ITP"), {delta_e_itp(color("1"), color("2"))}});
  });
}

Figures display_itp() {
  return figures_of_rows("itp_srgb", [&](Figures& figures, const ReferenceRow& row) {
    const auto color = [&](const char* of) {
      const auto number = [&](const char* part) {
        return kReferenceWhite * row.number(std::string(part) + of);
      };
      return itp(multiply(rgb_to_xyz(kRec709), {number("R"), number("G"), number("B")}));
    };
    figures.push_back({row.text("color"), row.number("dE_ITP"), {delta_e_itp(color("1"), color("2"))}});
  });
}

}  // namespace

std::vector<Case> color_metric_cases() {
  const ComputedCases computed{Suite::colour};
  return {
      computed("cct", "correlated colour temperature of illuminants", "nearest black body [Ohno2014]", "K",
               {0.0051},
               of_illuminants(kComputed, "CCT_K_360_830",
                              [](const Curve& c) { return temperature_of(c).kelvin; })),
      computed("cct-truncated", "correlated colour temperature of colours summed from 380 to 780 nm",
               "nearest black body [Ohno2014]", "K", {0.0051},
               of_illuminants(kComputed, "CCT_K",
                              [](const Curve& c) { return temperature_of(c, kVisibleRange).kelvin; })),
      computed("cct-black-body", "colour temperature of black bodies",
               "temperature of the black body itself [Planck1901]", "K", {1e-5, Margin::Kind::relative},
               black_body_temperatures),
      computed(
          "duv", "distance of illuminants from the Planckian locus", "nearest black body [Ohno2014]", "",
          {5.1e-7},
          of_illuminants(kComputed, "Duv_360_830", [](const Curve& c) { return temperature_of(c).duv; })),
      computed("duv-truncated", "distance from the Planckian locus of colours summed from 380 to 780 nm",
               "nearest black body [Ohno2014]", "", {5.1e-7},
               of_illuminants(kComputed, "Duv",
                              [](const Curve& c) { return temperature_of(c, kVisibleRange).duv; })),
      computed("cct-printed", "colour temperatures as printed, to 10 K and from 5 nm sums",
               "[CIE15, tables 10 and 12]", "K", {1.6e-3, Margin::Kind::relative},
               of_illuminants(kPrinted, "CCT_K", [](const Curve& c) { return temperature_of(c).kelvin; })),
      computed("scotopic", "ratio of scotopic to photopic flux", "[CIE18]", "", {6e-6},
               of_illuminants(kComputed, "S_over_P_360_830",
                              [](const Curve& c) { return scotopic_photopic_ratio(c); })),
      computed("scotopic-truncated", "ratio of scotopic to photopic flux, summed from 380 to 780 nm",
               "[CIE18]", "", {6e-6},
               of_illuminants(kComputed, "S_over_P",
                              [](const Curve& c) { return scotopic_photopic_ratio(c, kVisibleRange); })),
      computed(
          "cri", "general colour rendering index; the reference interpolates spectra by Sprague's rule",
          "[CIE13]", "", {0.1},
          of_illuminants(kComputed, "Ra",
                         [](const Curve& c) { return color_rendering(c, kVisibleRange).value().general; })),
      computed("cri-special", "R1 to R14 of FL1; the reference interpolates spectra by Sprague's rule",
               "[CIE13]", "", {0.3}, special_indices),
      computed(
          "cri-printed", "general colour rendering index as printed, in integers and from 5 nm sums",
          "[CIE15, table T.8]", "", {0.56},
          of_illuminants(kPrinted, "Ra", [](const Curve& c) { return color_rendering(c).value().general; })),
      computed(
          "fidelity", "colour fidelity; the reference uses 5 nm sums", "[CIE224]", "", {0.17},
          of_illuminants(kComputed, "Rf",
                         [](const Curve& c) { return color_fidelity(c, kVisibleRange).value().fidelity; })),
      computed("fidelity-example",
               "the worked example of CIE 224 and two fluorescent illuminants, as printed to 0.1", "[CIE224]",
               "", {0.07}, fidelity_example),
      computed("tm30", "FL2 by the calculator of TM-30, integers from 5 nm sums", "[TM30]", "", {0.65},
               printed_fidelity),
      computed("tm30-hue", "hue shifts of FL2 by that calculator", "[TM30]", "rad", {6e-3},
               printed_hue_shifts),
      computed("cam16", "correlates of CAM16", "[Li2017]", "", {5.1e-9},
               [] { return correlates("cam16", AppearanceModel::cam16); }),
      computed("ciecam02", "correlates of CIECAM02 as printed", "[CIE159]; [Fairchild2013]", "", {0.06},
               [] { return correlates("ciecam02", AppearanceModel::ciecam02); }),
      computed("dE-ITP", "colour differences for displays as printed", "[BT2124]", "ΔE", {1e-7}, printed_itp),
      computed("itp", "colour differences of sRGB primaries for displays with a white of 203 cd/m²",
               "[BT2100]; [BT2124]", "ΔE", {5.1e-4}, display_itp),
  };
}

}  // namespace abbe
