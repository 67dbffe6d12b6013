// The suite optics: formulas of materials and surfaces, and single rays traced by the code of `abbe trace`.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "materials/interface/fresnel.h"
#include "materials/interface/snell.h"
#include "sampling/angle.h"
#include "scene/shapes/basic.h"
#include "spectral/colorimetry.h"
#include "transport/path/ray_trace.h"
#include "validation/cases/suites.h"
#include "validation/cases/tables.h"

namespace abbe {
namespace {

double cosine(double degrees) {
  return degrees == 90 ? 0 : std::cos(degrees * kDegree);
}

struct NamedLine {
  const char* name;
  double wavelength_nm;  ///< In air.
};
constexpr NamedLine kC{"C", 656.2725};
constexpr NamedLine kD{"d", kLineD_nm};
constexpr NamedLine kF{"F", 486.1327};
constexpr NamedLine kG{"g", 435.8343};
constexpr NamedLine kH{"h", 404.6561};
constexpr std::array<NamedLine, 10> kLines{{kH,
                                            kG,
                                            {"Fprime", 479.9914},
                                            kF,
                                            {"e", 546.0740},
                                            kD,
                                            {"D", 589.2938},
                                            {"Cprime", 643.8469},
                                            kC,
                                            {"r", 706.5188}}};

Figures spectral_lines() {
  return figures_of_rows("refractive_index_lines", [&](Figures& figures, const ReferenceRow& row) {
    const std::string& id = row.text("id");
    const RefractiveIndex index = shipped_index(id);
    for (const auto& [line, nm] : kLines) {
      const std::string column = fmt::format("n_{}", line);
      if (!row.text(column).empty())
        figures.push_back({id + " " + line, row.number(column), {index.catalogued_n(nm)}});
    }
  });
}

Figures catalogue_indices() {
  return figures_of_rows("refractive_index_lines", [&](Figures& figures, const ReferenceRow& row) {
    const std::string& id = row.text("id");
    if (!row.text("nd_catalog").empty())
      figures.push_back({id, row.number("nd_catalog"), {shipped_index(id).catalogued_n(kLineD_nm)}});
  });
}

// Figures that `add` appends for each row of the table of glasses, from the name of its glass and the index
// at its wavelength.
template <typename Add>
Figures of_glasses(Add add) {
  return figures_of_rows("critical_brewster_fresnel", [&](Figures& figures, const ReferenceRow& row) {
    const std::string& id = row.text("id");
    add(figures, row, id + " " + row.text("line"),
        shipped_index(id).catalogued_n(row.number("wavelength_nm")));
  });
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

Figures critical_angles() {
  return of_glasses([](Figures& figures, const ReferenceRow& row, const std::string& name, double n) {
    figures.push_back({name, row.number("critical_deg"), {critical_angle(n)}});
  });
}

Figures brewster_reflectances() {
  return of_glasses([](Figures& figures, const ReferenceRow& row, const std::string& name, double n) {
    figures.push_back(
        {name + ", outside", 0, {fresnel_dielectric(cosine(row.number("brewster_outside_deg")), n).Rp}});
    figures.push_back(
        {name + ", inside", 0, {fresnel_dielectric(cosine(row.number("brewster_inside_deg")), 1 / n).Rp}});
  });
}

Figures glass_reflectances() {
  return of_glasses([](Figures& figures, const ReferenceRow& row, const std::string& name, double n) {
    for (const int angle : {0, 30, 45, 60, 75, 85}) {
      const FresnelPower<double> f = fresnel_dielectric(cosine(angle), n);
      figures.push_back(
          {fmt::format("{} s {}°", name, angle), row.number(fmt::format("Rs_{}", angle)), {f.Rs}});
      figures.push_back(
          {fmt::format("{} p {}°", name, angle), row.number(fmt::format("Rp_{}", angle)), {f.Rp}});
    }
  });
}

Figures metal_reflectances() {
  std::string loaded;
  RefractiveIndex index(1.0);
  return figures_of_rows("metal_reflectance", [&](Figures& figures, const ReferenceRow& row) {
    if (row.text("name") != loaded) index = shipped_index(loaded = row.text("name"));
    const double nm = row.number("wavelength_nm");
    const double angle = row.number("theta_deg");
    const FresnelPower<double> f = fresnel_conductor(cosine(angle), index.catalogued_n(nm), index.k(nm));
    const std::string what = fmt::format("{} {} nm {}°", loaded, nm, angle);
    figures.push_back({what + " s", row.number("Rs"), {f.Rs}});
    figures.push_back({what + " p", row.number("Rp"), {f.Rp}});
    figures.push_back({what, row.number("R_unpol"), {f.R()}});
  });
}

Figures metals_at_three_angles() {
  const RefractiveIndex silver = shipped_index("Ag_Johnson");
  const auto at = [](const char* name, double n, double k, double angle, double reference) {
    return Figure{
        fmt::format("{} 550 nm {}°", name, angle), reference, {fresnel_conductor(cosine(angle), n, k).R()}};
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

Figures schlick_errors() {
  Figures figures;
  const auto add = [&](const std::string& what, double n, double k, double reference) {
    figures.push_back({what, reference, {worst_of_schlick(n, k).first}});
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
    figures.push_back({what, degrees, {worst_of_schlick(n, 0).second}});
    figures.back().margin = Margin{0.11};
  }
  return figures;
}

Figures metal_colours() {
  return figures_of_rows("metal_colour_normal_incidence", [&](Figures& figures, const ReferenceRow& row) {
    const std::string& name = row.text("name");
    const std::string& light = row.text("illuminant");
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
        figures.push_back(
            {fmt::format("{} {} {}", name, light, letter), row.number(std::string(1, letter)), {value}});
      };
      add(letters[i], xyz[i]);
      add(letters[i + 3], lab[i]);
    }
  });
}

Figures absorption() {
  return figures_of_rows("beer_lambert", [&](Figures& figures, const ReferenceRow& row) {
    std::string name = row.text("name");
    if (name.ends_with("_k")) name.erase(name.size() - 2);
    const double nm = row.number("wavelength_nm");
    const double d = row.number("d_m");
    figures.push_back({fmt::format("{} {} nm {} m", name, nm, d),
                       row.number("tau"),
                       {std::exp(-shipped_index(name).absorption_per_m(nm) * d)}});
  });
}

// Reflectance in diffuse light: the integral of R(theta) sin(2 theta) by the midpoint rule. `n` is the index
// of the far side relative to the near side.
double hemispherical_reflectance(double n) {
  const auto integrand = [n](double theta) {
    return fresnel_dielectric(std::cos(theta), n).R() * std::sin(2 * theta);
  };
  return midpoint_integral(integrand, 0, std::numbers::pi / 2, 2000000);
}

Figures hemispherical() {
  return {{"from outside", 0.09177796, {hemispherical_reflectance(1.5)}},
          {"from inside", 0.59634576, {hemispherical_reflectance(1 / 1.5)}}};
}

using V3d = Imath::V3d;
constexpr double kMillimetre = 1e-3;

// Shapes of one glass of index n in air.
Scene glass_scene(double n, std::vector<Shape> shapes) {
  Scene scene{};
  scene.materials.push_back({"glass", DielectricMaterial{"constant", RefractiveIndex(n)}});
  for (Shape& shape : shapes) scene.shapes.push_back({"glass", std::move(shape), 0});
  scene.commit();
  return scene;
}

double index_at(const char* glass, const NamedLine& line) {
  return shipped_index(glass).catalogued_n(line.wavelength_nm);
}

// Figure at each spectral line, from its reference.
Figures of_lines(std::initializer_list<std::pair<NamedLine, double>> references,
                 const std::function<double(const NamedLine&)>& measure) {
  Figures figures;
  for (const auto& [line, reference] : references) figures.push_back({line.name, reference, {measure(line)}});
  return figures;
}

// A ray that hits the first face of a prism of side 30 mm from below its normal.
struct PrismRay {
  RayTrace trace;
  double deviation_deg;

  // True if the second face transmits the ray.
  [[nodiscard]] bool leaves() const { return trace.events.at(1).kind == TraceEvent::Kind::refract; }
};
PrismRay trace_prism(double n, double apex_deg, double incidence_deg) {
  constexpr double kSide = 30 * kMillimetre;
  const double half = apex_deg / 2 * kDegree;
  const double elevation = incidence_deg * kDegree - half;
  const V3d direction(std::cos(elevation), 0, std::sin(elevation));
  const V3d face_center(-kSide / 2 * std::sin(half), 1.25 * kMillimetre, kSide / 6 * std::cos(half));
  const Scene scene = glass_scene(n, {make_prism(apex_deg, kSide, 40 * kMillimetre)});
  const RayTrace trace = trace_ray(scene, {face_center - 0.1 * direction, direction}, kLineD_nm, 64);
  return {trace, angle_deg(direction, trace.last.direction)};
}

// Angle of incidence [degrees] at which light crosses a prism symmetrically.
double minimum_deviation_incidence(double n, double apex_deg) {
  return std::asin(n * std::sin(apex_deg / 2 * kDegree)) / kDegree;
}

Figures minimum_deviations() {
  return figures_of_rows("prism_minimum_deviation", [&](Figures& figures, const ReferenceRow& row) {
    if (row.text("min_deviation_deg").empty()) return;
    const std::string& id = row.text("id");
    const double apex = row.number("apex_deg");
    const double n = shipped_index(id).catalogued_n(row.number("wavelength_nm"));
    figures.push_back({id + " " + row.text("line"),
                       row.number("min_deviation_deg"),
                       {trace_prism(n, apex, minimum_deviation_incidence(n, apex)).deviation_deg}});
  });
}

Figures deviations_at_50() {
  return of_lines(
      {{kC, 38.43841}, {kD, 38.65364}, {kF, 39.14097}, {kH, 39.83544}},
      [&](const NamedLine& line) { return trace_prism(index_at("N-BK7", line), 60, 50).deviation_deg; });
}

// Distances [mm] from the d line on a screen 1 m away, at the minimum deviation of that line.
Figures screen_positions() {
  const double incidence = minimum_deviation_incidence(index_at("N-BK7", kD), 60);
  const auto deviation = [&](const NamedLine& line) {
    return trace_prism(index_at("N-BK7", line), 60, incidence).deviation_deg;
  };
  return of_lines({{kC, -3.79405}, {kF, 8.59336}, {kG, 15.28664}, {kH, 20.84728}},
                  [&](const NamedLine& line) {
                    return std::tan((deviation(line) - deviation(kD)) * kDegree) / kMillimetre;
                  });
}

// Smallest incidence at which the second face transmits, by bisection.
double edge_of_transmission(double n) {
  double low = 20;
  double high = 50;
  while (high - low > 1e-9) {
    const double midpoint = (low + high) / 2;
    (trace_prism(n, 60, midpoint).leaves() ? high : low) = midpoint;
  }
  return high;
}

Figures edges_of_transmission() {
  return of_lines({{kC, 29.00097}, {kD, 29.18821}, {kF, 29.61000}},
                  [&](const NamedLine& line) { return edge_of_transmission(index_at("N-BK7", line)); });
}

Figures prism_throughput() {
  const double n = index_at("N-BK7", kD);
  const RayTrace trace = trace_prism(n, 60, minimum_deviation_incidence(n, 60)).trace;
  const Passage& in = trace.events.at(0).passage.value();
  const Passage& out = trace.events.at(1).passage.value();
  const double s = (1 - in.Rs) * (1 - out.Rs);
  const double p = (1 - in.Rp) * (1 - out.Rp);
  const double chained = (1 - (in.Rs + in.Rp) / 2) * (1 - (out.Rs + out.Rp) / 2);
  return {{"s", 0.786084, {s}},
          {"p", 0.991278, {p}},
          {"unpolarised", 0.888681, {trace.polarisation.mueller.rows[0][0]}},
          {"polarisation off", 0.885710, {chained}}};
}

// Lateral shift by a plate 10 mm thick at 45 degrees.
double lateral_shift_mm(double n) {
  constexpr double kThickness = 10 * kMillimetre;
  const Quad front{{0, -1, -1}, {0, 0, 2}, {0, 2, 0}};
  const Quad back{{kThickness, -1, -1}, {0, 2, 0}, {0, 0, 2}};
  const double c = std::sqrt(0.5);
  const V3d origin(-0.01, 0.003, -0.01);
  const RayTrace trace = trace_ray(glass_scene(n, {front, back}), {origin, {c, 0, c}}, kLineD_nm, 64);
  const V3d moved = trace.last.origin - origin;
  return (moved.x - moved.z) * c / kMillimetre;
}

Figures lateral_shifts() {
  return of_lines({{kC, 3.337199}, {kD, 3.344994}, {kF, 3.362405}},
                  [&](const NamedLine& line) { return lateral_shift_mm(index_at("N-BK7", line)); });
}

// Focal length of a ball 10 mm wide, from a paraxial ray.
double ball_focal_length_mm(double n) {
  constexpr double kHeight = 1e-7;
  const Scene scene = glass_scene(n, {Sphere{{0, 0, 0}, 5 * kMillimetre}});
  const RayTrace trace = trace_ray(scene, {{-0.1, 0, kHeight}, {1, 0, 0}}, kLineD_nm, 64);
  return kHeight / std::tan(angle_deg({1, 0, 0}, trace.last.direction) * kDegree) / kMillimetre;
}

Figures ball_lens() {
  return of_lines({{kC, 7.360765}, {kD, 7.337461}, {kF, 7.285822}},
                  [&](const NamedLine& line) { return ball_focal_length_mm(index_at("N-BK7", line)); });
}

// Total deviation [degrees] of a ray that enters a ball of index n at this incidence and leaves after k
// internal reflections.
double droplet_deviation(double n, double incidence_deg, int k) {
  const Sphere ball{V3d(0), 1};
  const double i = incidence_deg * kDegree;
  BasicRay<double> ray{V3d(std::sin(i), 0, 5), V3d(0, 0, -1)};
  double turned = 0;
  for (int event = 0; event <= k + 1; ++event) {
    const auto hit = intersect(ball, ray, 1e-9);
    if (!hit) return std::nan("");
    const bool last = event == k + 1;
    V3d next = event == 0 ? *refract(-ray.direction, hit->normal, n)
                          : reflect(V3d(-ray.direction), V3d(-hit->normal));
    if (last) next = *refract(-ray.direction, V3d(-hit->normal), 1 / n);
    turned += angle_deg(ray.direction, next);
    ray = {hit->point, next};
  }
  return turned;
}

Figures water_bows() {
  const RefractiveIndex water = shipped_index("water_20.0C");
  return figures_of_rows("rainbow_water_20C", [&](Figures& figures, const ReferenceRow& row) {
    const double nm = row.number("wavelength_nm");
    const bool absolute = row.text("index_used") == "absolute";
    const double n = absolute ? water.catalogued_n(nm) : water.n(nm);
    const int order = static_cast<int>(row.number("order_k"));
    figures.push_back({fmt::format("{} nm order {}{}", nm, order, absolute ? " in vacuum" : ""),
                       row.number("deviation_deg"),
                       {droplet_deviation(n, row.number("incidence_deg"), order)}});
  });
}

Figures printed_bows() {
  constexpr std::array kIndices{1.331, 1.343};
  constexpr std::array<std::array<double, 2>, 7> kPrinted{{{137.63, 139.35},
                                                           {129.63, 126.52},
                                                           {42.47, 38.11},
                                                           {42.76, 48.34},
                                                           {127.08, 133.86},
                                                           {149.10, 141.13},
                                                           {65.59, 56.45}}};
  Figures figures;
  for (std::size_t i = 0; i < kPrinted.size(); ++i)
    for (std::size_t j = 0; j < kIndices.size(); ++j) {
      const int order = static_cast<int>(i) + 1;
      const double n = kIndices[j];
      const double incidence = std::acos(std::sqrt((n * n - 1) / (order * (order + 2)))) / kDegree;
      const double turned = std::fmod(droplet_deviation(n, incidence, order), 360);
      figures.push_back(
          {fmt::format("order {} n = {}", order, n), kPrinted[i][j], {std::min(turned, 360 - turned)}});
    }
  return figures;
}

}  // namespace

std::vector<Case> optics_cases() {
  const ComputedCases computed{Suite::optics};
  const Margin printed{0.5001e-8};
  const std::string prism = "two refractions [Born1999, sec. 4.7.2]";
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
      computed("D1", "minimum deviation of 60° prisms, traced", prism, "°", {0.51e-6}, minimum_deviations),
      computed("D2", "N-BK7 prism, deviation at 50° of incidence, traced", prism, "°", {0.51e-5},
               deviations_at_50),
      computed("D3", "N-BK7 prism, lines on a screen 1 m away", prism, "mm", {0.51e-5}, screen_positions),
      computed("D4", "N-BK7 prism, incidence at which the second face begins to transmit", prism, "°",
               {0.51e-5}, edges_of_transmission),
      computed("D5", "N-BK7 prism, throughput at minimum deviation",
               prism + " and Fresnel's formulas [Born1999, sec. 1.5.2]", "", {0.51e-6}, prism_throughput),
      // The table evaluates the index of air at the nominal wavelength as if in vacuum: 1e-8 in n, 3e-6
      // degrees here.
      computed("D6", "rainbows of water, traced through a sphere",
               "Descartes' rays [VanDeHulst1957, chap. 13]", "°", {5e-6}, water_bows),
      computed(
          "D6-printed", "rainbows of seven orders as printed, traced through a sphere",
          "as a textbook prints them for n = 1.331 and 1.343; Descartes' rays [VanDeHulst1957, chap. 13]",
          "°", {0.0051}, printed_bows),
      computed("D7-plate", "N-BK7 plate of 10 mm at 45°, lateral shift, traced",
               "t (sin i - cos i tan r) [Born1999, sec. 1.5.1]", "mm", {0.51e-6}, lateral_shifts),
      computed("D7-ball", "N-BK7 ball of 10 mm, focal length, traced", "nD/(4(n - 1)) [Born1999, sec. 4.4]",
               "mm", {0.51e-6}, ball_lens),
  };
}

}  // namespace abbe
