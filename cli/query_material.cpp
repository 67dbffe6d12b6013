#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/query.h"
#include "io/text.h"
#include "materials/index/library.h"
#include "materials/interface/coating.h"
#include "materials/interface/film_thickness.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/prism.h"
#include "sampling/angle.h"

namespace abbe::cli {
namespace {

// The material of that name, which must hold at all wavelengths asked for.
NamedIndex find(const std::string& name, const std::vector<double>& at_nm) {
  Diagnostics diagnostics;
  NamedIndex found = accepted(load_index(name, {}, diagnostics), diagnostics);
  require_data_at(found, at_nm, "--at");
  return found;
}

// The same, to tell what its surface reflects.
NamedIndex find_surface(const std::string& name, const std::vector<double>& at_nm) {
  NamedIndex found = find(name, at_nm);
  require_k_at(found, at_nm, "--at");
  return found;
}

// One value per wavelength.
template <typename F>
Json each(const std::vector<double>& at_nm, F value) {
  Json list = Json::array();
  for (const double nm : at_nm) list.push_back(value(nm));
  return list;
}

template <typename Options>
int print_material_answer(const Json& answer, const Options& options) {
  print(options.arrays ? answer : without_lists_of_one(answer), options.json);
  return 0;
}

// The medium that the catalogued index of a material is relative to.
const char* medium_of(const NamedIndex& material) {
  return material.index.medium() == IndexMedium::vacuum ? "vacuum" : "air";
}

// The medium around every surface that is asked about, as in scenes.
constexpr const char* kSurroundings = "air";

// An angle of n and k at each wavelength.
template <typename F>
Json angles(const NamedIndex& material, const IndexOptions& options, F angle) {
  Json answer;
  answer["name"] = material.name;
  answer["medium"] = kSurroundings;
  answer["wavelength_nm"] = options.at_nm;
  answer["angle_deg"] =
      each(options.at_nm, [&](double nm) { return angle(material.index.n(nm), material.index.k(nm)); });
  return answer;
}

// R_p of light from outside.
long double reflected_p(double n, double k, long double degrees) {
  const long double cos_i = std::cos(degrees * static_cast<long double>(kDegree));
  return fresnel_conductor<long double>(cos_i, n, k).Rp;
}

// Where that is least, by the golden section between the neighbours of the least of whole degrees.
double least_p_deg(double n, double k) {
  const auto reflected = [n, k](long double degrees) { return reflected_p(n, k, degrees); };
  long double low = 0;
  for (int degrees = 1; degrees < 90; ++degrees)
    if (reflected(degrees) < reflected(low)) low = degrees;
  low = std::max(low - 1, 0.0L);
  long double high = low + 2;
  constexpr long double kSection = std::numbers::phi_v<long double> - 1;
  constexpr int kSections = 100;
  for (int i = 0; i < kSections; ++i) {
    const long double inner = kSection * (high - low);
    if (reflected(high - inner) < reflected(low + inner))
      high = low + inner;
    else
      low = high - inner;
  }
  return static_cast<double>(low + (high - low) / 2);
}

// "MATERIAL:NM,..." from outside inwards.
Coating parse_coating(const std::string& text, const std::vector<double>& at_nm) {
  Coating coating;
  if (text.empty()) return coating;
  for (const std::string& layer : split(text, ',')) {
    const std::size_t colon = layer.rfind(':');
    const auto thickness = parse_number(colon == std::string::npos ? "" : layer.substr(colon + 1));
    if (!thickness || !kFilmThickness.contains(*thickness) || coating.layers.size() == Coating::kMaxMaterials)
      throw Error(ErrorCode::usage, "--coating",
                  fmt::format("got \"{}\", allowed up to {} layers MATERIAL:NANOMETRES, of {} nm", text,
                              Coating::kMaxMaterials, kFilmThickness.text()));
    NamedIndex material = find_surface(layer.substr(0, colon), at_nm);
    coating.layers.push_back({static_cast<std::uint32_t>(coating.materials.size()), *thickness});
    coating.materials.push_back({std::move(material.name), std::move(material.index)});
  }
  return coating;
}

struct ReflectedFromAir {
  FresnelPower<double> power;
  FilmReflection<double> amplitudes;
};
ReflectedFromAir reflect_from_air(const RefractiveIndex& index, const Coating& coating, double nm,
                                  double angle_deg) {
  const double cos_i = angle_deg == 90 ? 0 : std::cos(angle_deg * kDegree);
  const double n = index.n(nm);
  const double k = index.k(nm);
  return {coated_power(coating, nm, n, k, cos_i, false), coated_reflection(coating, nm, n, k, cos_i, false)};
}

// In [0, 360], so that what glass reflects with next to no absorption stays near half a turn, or none.
double phase_deg(const Complex<double>& amplitude) {
  const double phase = std::atan2(amplitude.im + 0.0, amplitude.re) / kDegree;  // of no negative zero
  return phase < 0 ? phase + 360 : phase;
}

}  // namespace

int query_ior(const IndexOptions& options) {
  const NamedIndex material = find(options.name, options.at_nm);
  Json answer;
  answer["name"] = material.name;
  answer["source"] = material.source;
  answer["medium"] = medium_of(material);
  answer["wavelength_nm"] = options.at_nm;
  answer["n"] = each(options.at_nm, [&](double nm) { return material.index.catalogued_n(nm); });
  const auto where_k_is_known = [&](auto quantity) {
    return each(options.at_nm,
                [&](double nm) { return material.index.knows_k(nm) ? Json(quantity(nm)) : Json(); });
  };
  answer["k"] = where_k_is_known([&](double nm) { return material.index.catalogued_k(nm); });
  if (options.thickness_mm)
    answer["internal_transmittance"] = where_k_is_known([&](double nm) {
      return std::exp(-material.index.absorption_per_m(nm) * *options.thickness_mm * 1e-3);
    });
  return print_material_answer(answer, options);
}

int query_critical(const IndexOptions& options) {
  // 4 pi k at which a wave falls to 1/e over a wavelength, so that none goes on within to be reflected.
  constexpr double kMostOfWaves = 1;
  const auto critical = [](double n, double k) {
    const bool is_wave = 4 * std::numbers::pi * k < kMostOfWaves;
    return n > 1 && is_wave ? Json(std::asin(1 / n) / kDegree) : Json();
  };
  return print_material_answer(angles(find_surface(options.name, options.at_nm), options, critical), options);
}

int query_brewster(const IndexOptions& options) {
  // A share of the light that is as good as none: what glass reflects for its k.
  constexpr double kNone = 1e-9;
  const NamedIndex material = find_surface(options.name, options.at_nm);
  const auto polarising = [](double n, double k) {
    return k > 0 ? least_p_deg(n, k) : std::atan(n) / kDegree;
  };
  Json answer = angles(material, options, polarising);
  for (std::size_t i = 0; i < options.at_nm.size(); ++i) {
    const double least =
        reflect_from_air(material.index, {}, options.at_nm[i], answer["angle_deg"][i]).power.Rp;
    answer["kind"].push_back(least < kNone ? "Brewster" : "pseudo-Brewster");
    answer["Rp"].push_back(least);
  }
  return print_material_answer(answer, options);
}

int query_reflectance(const ReflectanceOptions& options) {
  const NamedIndex material = find_surface(options.name, options.at_nm);
  const Coating coating = parse_coating(options.coating, options.at_nm);
  const auto rows = [&](auto quantity) {
    return each(options.at_nm, [&](double nm) {
      Json row = Json::array();
      for (const double angle : options.angles_deg)
        row.push_back(quantity(reflect_from_air(material.index, coating, nm, angle)));
      return row;
    });
  };
  Json answer;
  answer["name"] = material.name;
  answer["medium"] = kSurroundings;
  answer["angle_deg"] = options.angles_deg;
  answer["wavelength_nm"] = options.at_nm;
  answer["Rs"] = rows([](const auto& f) { return f.power.Rs; });
  answer["Rp"] = rows([](const auto& f) { return f.power.Rp; });
  answer["R"] = rows([](const auto& f) { return f.power.R(); });
  if (!coating.layers.empty()) answer["T"] = rows([](const auto& f) { return f.power.transmitted(); });
  answer["phase_s_deg"] = rows([](const auto& f) { return phase_deg(f.amplitudes.s); });
  answer["phase_p_deg"] = rows([](const auto& f) { return phase_deg(f.amplitudes.p); });
  return print_material_answer(answer, options);
}

int query_prism(const PrismOptions& options) {
  const NamedIndex material = find_surface(options.name, options.at_nm);
  const auto column = [&](auto quantity) {
    return each(options.at_nm, [&](double nm) {
      if (material.index.k(nm) > kLargestGlassK) return Json();
      const double n = material.index.n(nm);
      const auto passage = options.incidence_deg ? prism_passage(n, options.apex_deg, *options.incidence_deg)
                                                 : prism_minimum(n, options.apex_deg);
      return passage ? Json(quantity(*passage)) : Json();
    });
  };
  Json answer;
  answer["name"] = material.name;
  answer["medium"] = kSurroundings;
  answer["apex_deg"] = options.apex_deg;
  answer["wavelength_nm"] = options.at_nm;
  answer["n"] = each(options.at_nm, [&](double nm) { return material.index.n(nm); });
  answer["deviation_deg"] = column([](const PrismPassage& p) { return p.deviation_deg; });
  answer["incidence_deg"] = column([](const PrismPassage& p) { return p.incidence_deg; });
  answer["Ts"] = column([](const PrismPassage& p) { return p.Ts; });
  answer["Tp"] = column([](const PrismPassage& p) { return p.Tp; });
  return print_material_answer(answer, options);
}

}  // namespace abbe::cli
