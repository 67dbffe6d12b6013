#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "io/table.h"
#include "materials/interface/fresnel.h"
#include "sampling/angle.h"
#include "spectral/colorimetry.h"
#include "validation/cases/figures.h"
#include "validation/cases/quadrature.h"
#include "validation/cases/suites.h"
#include "validation/cases/tables.h"

namespace abbe {
namespace {

double cosine(double degrees) {
  return degrees == 90 ? 0 : std::cos(degrees * kDegree);
}

std::vector<Figure> spectral_lines() {
  constexpr std::array<std::pair<const char*, double>, 10> kLines{{{"h", kLineH_nm},
                                                                   {"g", kLineG_nm},
                                                                   {"Fprime", 479.9914},
                                                                   {"F", kLineF_nm},
                                                                   {"e", 546.0740},
                                                                   {"d", kLineD_nm},
                                                                   {"D", 589.2938},
                                                                   {"Cprime", 643.8469},
                                                                   {"C", kLineC_nm},
                                                                   {"r", 706.5188}}};
  const ReferenceTable table("refractive_index_lines");
  std::vector<Figure> figures;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& id = table.text(row, "id");
    const RefractiveIndex index = shipped_index(id);
    for (const auto& [line, nm] : kLines) {
      const std::string column = fmt::format("n_{}", line);
      if (!table.text(row, column).empty())
        figures.push_back(exact_figure(id + " " + line, table.number(row, column), index.catalogued_n(nm)));
    }
  }
  return figures;
}

std::vector<Figure> catalogue_indices() {
  const ReferenceTable table("refractive_index_lines");
  std::vector<Figure> figures;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& id = table.text(row, "id");
    if (!table.text(row, "nd_catalog").empty())
      figures.push_back(
          exact_figure(id, table.number(row, "nd_catalog"), shipped_index(id).catalogued_n(kLineD_nm)));
  }
  return figures;
}

// Collects what `add` appends for each row of the table. `add` receives the name of the row's glass and the
// index at its wavelength.
std::vector<Figure> of_glasses(
    const std::function<void(std::vector<Figure>&, const ReferenceTable&, std::size_t row,
                             const std::string& name, double n)>& add) {
  const ReferenceTable table("critical_brewster_fresnel");
  std::vector<Figure> figures;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& id = table.text(row, "id");
    add(figures, table, row, id + " " + table.text(row, "line"),
        shipped_index(id).catalogued_n(table.number(row, "wavelength_nm")));
  }
  return figures;
}

// Smallest angle of total internal reflection [degrees], by bisection.
double critical_angle(double n) {
  double low = 0;
  double high = 90;
  while (high - low > 1e-10) {
    const double midpoint = (low + high) / 2;
    (fresnel_dielectric(cosine(midpoint), 1 / n).Ts > 0 ? low : high) = midpoint;
  }
  return (low + high) / 2;
}

std::vector<Figure> critical_angles() {
  return of_glasses([](std::vector<Figure>& figures, const ReferenceTable& table, std::size_t row,
                       const std::string& name, double n) {
    figures.push_back(exact_figure(name, table.number(row, "critical_deg"), critical_angle(n)));
  });
}

std::vector<Figure> brewster_reflectances() {
  return of_glasses([](std::vector<Figure>& figures, const ReferenceTable& table, std::size_t row,
                       const std::string& name, double n) {
    figures.push_back(exact_figure(
        name + ", outside", 0, fresnel_dielectric(cosine(table.number(row, "brewster_outside_deg")), n).Rp));
    figures.push_back(
        exact_figure(name + ", inside", 0,
                     fresnel_dielectric(cosine(table.number(row, "brewster_inside_deg")), 1 / n).Rp));
  });
}

std::vector<Figure> glass_reflectances() {
  return of_glasses([](std::vector<Figure>& figures, const ReferenceTable& table, std::size_t row,
                       const std::string& name, double n) {
    for (const int angle : {0, 30, 45, 60, 75, 85}) {
      const FresnelPower<double> f = fresnel_dielectric(cosine(angle), n);
      figures.push_back(exact_figure(fmt::format("{} s {}°", name, angle),
                                     table.number(row, fmt::format("Rs_{}", angle)), f.Rs));
      figures.push_back(exact_figure(fmt::format("{} p {}°", name, angle),
                                     table.number(row, fmt::format("Rp_{}", angle)), f.Rp));
    }
  });
}

std::vector<Figure> metal_reflectances() {
  const ReferenceTable table("metal_reflectance");
  std::vector<Figure> figures;
  std::string loaded;
  RefractiveIndex index(1.0);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.text(row, "name") != loaded) index = shipped_index(loaded = table.text(row, "name"));
    const double nm = table.number(row, "wavelength_nm");
    const double angle = table.number(row, "theta_deg");
    const FresnelPower<double> f = fresnel_conductor(cosine(angle), index.catalogued_n(nm), index.k(nm));
    const std::string what = fmt::format("{} {} nm {}°", loaded, nm, angle);
    figures.push_back(exact_figure(what + " s", table.number(row, "Rs"), f.Rs));
    figures.push_back(exact_figure(what + " p", table.number(row, "Rp"), f.Rp));
    figures.push_back(exact_figure(what, table.number(row, "R_unpol"), f.R()));
  }
  return figures;
}

std::vector<Figure> metals_at_three_angles() {
  const RefractiveIndex silver = shipped_index("Ag_Johnson");
  const auto at = [](const char* name, double n, double k, double angle, double reference) {
    return exact_figure(fmt::format("{} 550 nm {}°", name, angle), reference,
                        fresnel_conductor(cosine(angle), n, k).R());
  };
  const double n = silver.catalogued_n(550);
  const double k = silver.k(550);
  return {at("Al", 1.0152, 6.6273, 0, .915369),  at("Al", 1.0152, 6.6273, 60, .900335),
          at("Al", 1.0152, 6.6273, 80, .859760), at("Ag", n, k, 0, .983054),
          at("Ag", n, k, 60, .981033),           at("Ag", n, k, 80, .983150)};
}

// Largest error of Schlick's approximation and its angle, in steps of a tenth of a degree.
std::pair<double, double> worst_of_schlick(double n, double k) {
  const double r0 = fresnel_conductor(1.0, n, k).R();
  std::pair<double, double> worst{0, 0};
  for (int tenth = 0; tenth < 900; ++tenth) {
    const double c = cosine(tenth / 10.0);
    worst = std::max(worst, {std::abs(schlick(c, r0) - fresnel_conductor(c, n, k).R()), tenth / 10.0});
  }
  return worst;
}

std::vector<Figure> schlick_errors() {
  std::vector<Figure> figures;
  const auto add = [&](const std::string& what, double n, double k, double reference) {
    figures.push_back(exact_figure(what, reference, worst_of_schlick(n, k).first));
  };
  const auto add_metal = [&](const char* name, double nm, double reference) {
    const RefractiveIndex index = shipped_index(name);
    add(fmt::format("{} {} nm", name, nm), index.catalogued_n(nm), index.k(nm), reference);
  };
  add("n = 1.5", 1.5, 0, .0357);
  add("water", shipped_index("water_20.0C").catalogued_n(kLineD_nm), 0, .0591);
  add("diamond, n = 2.417", 2.417, 0, .0754);
  add_metal("Al_Rakic", 650, .1296);
  add_metal("Au_Johnson", 550, .0103);
  add_metal("Cu_Johnson", 450, .0396);
  for (const auto& [what, n, degrees] :
       {std::tuple{"n = 1.5, angle [°]", 1.5, 85.0}, std::tuple{"n = 1.333, angle [°]", 1.333, 83.8}}) {
    figures.push_back(exact_figure(what, degrees, worst_of_schlick(n, 0).second));
    figures.back().margin = Margin{0.11};
  }
  return figures;
}

std::vector<Figure> metal_colours() {
  const ReferenceTable table("metal_colour_normal_incidence");
  std::vector<Figure> figures;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& name = table.text(row, "name");
    const std::string& light = table.text(row, "illuminant");
    const RefractiveIndex index = shipped_index(name);
    std::vector<Knot> knots;
    for (int nm = kVisibleRange.low_nm; nm <= kVisibleRange.high_nm; ++nm)
      knots.push_back({static_cast<double>(nm), fresnel_conductor(1.0, index.n(nm), index.k(nm)).R()});
    const Curve illuminant = shipped_illuminant(light);
    const auto summed = [&illuminant](const Curve& reflectance) {
      return tristimulus(illuminant, reflectance, Observer::cie1931, kVisibleRange);
    };
    const XYZ xyz = summed(Curve(std::move(knots)));
    const Lab lab = xyz_to_lab(xyz, summed(Curve(1.0)));
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string letters = "XYZLab";
      const auto add = [&](char letter, double value) {
        figures.push_back(exact_figure(fmt::format("{} {} {}", name, light, letter),
                                       table.number(row, std::string(1, letter)), value));
      };
      add(letters[i], xyz[i]);
      add(letters[i + 3], lab[i]);
    }
  }
  return figures;
}

std::vector<Figure> absorption() {
  const ReferenceTable table("beer_lambert");
  std::vector<Figure> figures;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    std::string name = table.text(row, "name");
    if (name.ends_with("_k")) name.erase(name.size() - 2);
    const double nm = table.number(row, "wavelength_nm");
    const double d = table.number(row, "d_m");
    figures.push_back(exact_figure(fmt::format("{} {} nm {} m", name, nm, d), table.number(row, "tau"),
                                   std::exp(-shipped_index(name).absorption_per_m(nm) * d)));
  }
  return figures;
}

// Reflectance in diffuse light: the integral of R(theta) sin(2 theta) by the midpoint rule. `n` is the index
// of the far side relative to the near side.
double hemispherical_reflectance(double n) {
  const auto integrand = [n](double theta) {
    return fresnel_dielectric(std::cos(theta), n).R() * std::sin(2 * theta);
  };
  return midpoint_integral(integrand, 0, std::numbers::pi / 2, 2000000);
}

std::vector<Figure> hemispherical() {
  return {exact_figure("from outside", 0.09177796, hemispherical_reflectance(1.5)),
          exact_figure("from inside", 0.59634576, hemispherical_reflectance(1 / 1.5))};
}

// A case of the suite optics.
Case computed(std::string id, std::string title, std::string source, std::string unit, Margin margin,
              std::vector<Figure> (*figures)()) {
  return computed_case(Suite::optics, std::move(id), std::move(title), std::move(source), std::move(unit),
                       margin, figures);
}

}  // namespace

std::vector<Case> optics_cases() {
  const Margin printed{0.5001e-8};
  return {
      computed("index-lines", "indices of all dielectrics at ten spectral lines",
               "dispersion formulas and coefficients [Polyanskiy2024]", "", {0.5001e-7}, spectral_lines),
      computed("index-catalogue", "indices at the d line as the makers print them",
               "makers' catalogues, as collected in [Polyanskiy2024]", "", {1e-5}, catalogue_indices),
      computed("critical", "critical angles of glass, water and crystals", "asin(1/n) [Born1999, sec. 1.5.4]",
               "°", {0.51e-6}, critical_angles),
      computed("brewster", "no reflection of p light at Brewster's angle", "atan(n) [Born1999, sec. 1.5.3]",
               "", {1e-14}, brewster_reflectances),
      computed("fresnel-glass", "reflectance of dielectrics for s and p light",
               "Fresnel's formulas [Born1999, sec. 1.5.2]", "", printed, glass_reflectances),
      computed("fresnel-metal", "reflectance of metals and semiconductors for s and p light",
               "Fresnel's formulas with n + ik [Born1999, sec. 14.2]", "", printed, metal_reflectances),
      computed("fresnel-angles", "aluminium and silver at 0°, 60° and 80°",
               "Fresnel's formulas with n + ik [Born1999, sec. 14.2]", "", {1e-6}, metals_at_three_angles),
      computed("schlick", "largest errors of Schlick's approximation",
               "[Schlick1994] against Fresnel's formulas [Born1999, sec. 14.2]", "", {0.51e-4},
               schlick_errors),
      computed("metal-colour", "colour of metals at normal incidence, XYZ and L*a*b*",
               "Fresnel's formulas and 1 nm sums [CIE15, sec. 7.1]", "", {2e-5}, metal_colours),
      computed("beer", "internal transmittance of glass and water", "exp(-4πkd/λ) [Born1999, sec. 14.1]", "",
               printed, absorption),
      computed("T16", "reflectance of glass, n = 1.5, for diffuse light",
               "Fresnel's formulas over a hemisphere [Born1999, sec. 1.5.2]", "", {1e-8}, hemispherical),
  };
}

}  // namespace abbe
