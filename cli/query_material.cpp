#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/query.h"
#include "io/text.h"
#include "materials/index/library.h"
#include "materials/interface/coating.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/prism.h"
#include "sampling/angle.h"

namespace abbe::cli {
namespace {

// Material of this name. Throws Error{usage} if its table does not contain all requested wavelengths.
NamedIndex find_material(const std::string& name, const std::vector<double>& at_nm) {
  Diagnostics diagnostics;
  NamedIndex material = accepted(load_index(name, {}, diagnostics), diagnostics);
  require_data_at(material, at_nm, "--at");
  return material;
}

// Material for questions about reflection, which also need k at all requested wavelengths.
NamedIndex find_surface(const std::string& name, const std::vector<double>& at_nm) {
  NamedIndex material = find_material(name, at_nm);
  require_k_at(material, at_nm, "--at");
  return material;
}

// List of `value` at each wavelength.
template <typename F>
Json per_wavelength(const std::vector<double>& at_nm, F value) {
  Json list = Json::array();
  for (const double nm : at_nm) list.push_back(value(nm));
  return list;
}

template <typename Options>
void print_material_answer(const Json& answer, const Options& options) {
  print(options.arrays ? answer : without_lists_of_one(answer), options.json);
}

// Medium that surrounds every surface in the answers, as in scenes.
constexpr const char* kAmbientMedium = "air";

// Answer with an angle per wavelength, computed from n and k.
template <typename F>
Json angles(const NamedIndex& material, const IndexOptions& options, F angle) {
  Json answer;
  answer["name"] = material.name;
  answer["medium"] = kAmbientMedium;
  answer["wavelength_nm"] = options.at_nm;
  answer["angle_deg"] = per_wavelength(
      options.at_nm, [&](double nm) { return angle(material.index.n(nm), material.index.k(nm)); });
  return answer;
}

// Angle in degrees of minimum R_p, by a golden-section search between the neighbours of the best whole
// degree.
double min_p_angle_deg(double n, double k) {
  const auto reflected = [n, k](long double degrees) {
    const long double cos_i = std::cos(degrees * static_cast<long double>(kDegree));
    return fresnel_conductor<long double>(cos_i, n, k).Rp;
  };
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

// Parses "MATERIAL:NM,...", thin films ordered from outside inwards.
Coating parse_coating(const std::string& text, const std::vector<double>& at_nm) {
  Coating coating;
  if (text.empty()) return coating;
  for (const std::string& layer : split(text, ',')) {
    const std::size_t colon = layer.rfind(':');
    const auto thickness = parse_number(colon == std::string::npos ? "" : layer.substr(colon + 1));
    if (!thickness || !kFilmThickness.contains(*thickness) || coating.layers.size() == Coating::kMaxMaterials)
      throw Error(ErrorCode::usage, "--coating",
                  fmt::format("got \"{}\", allowed up to {} layers MATERIAL:NM with thicknesses of {} nm",
                              text, Coating::kMaxMaterials, kFilmThickness.text()));
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
// Reflected power and amplitudes at an angle of incidence in degrees.
ReflectedFromAir reflect_from_air(const RefractiveIndex& index, const Coating& coating, double nm,
                                  double angle_deg) {
  const double cos_i = angle_deg == 90 ? 0 : std::cos(angle_deg * kDegree);
  const double n = index.n(nm);
  const double k = index.k(nm);
  return {coated_power(coating, nm, n, k, cos_i, false), coated_reflection(coating, nm, n, k, cos_i, false)};
}

// Phase in degrees in [0, 360]. Reflections from glass with negligible absorption stay close to 180, instead
// of alternating between 180 and -180.
double phase_deg(const Complex<double>& amplitude) {
  const double phase = std::atan2(amplitude.im + 0.0, amplitude.re) / kDegree;  // removes negative zeros
  return phase < 0 ? phase + 360 : phase;
}

}  // namespace

void query_ior(const IndexOptions& options) {
  const NamedIndex material = find_material(options.name, options.at_nm);
  Json answer;
  answer["name"] = material.name;
  answer["source"] = material.source;
  answer["medium"] = material.index.medium() == IndexMedium::vacuum ? "vacuum" : "air";
  answer["wavelength_nm"] = options.at_nm;
  answer["n"] = per_wavelength(options.at_nm, [&](double nm) { return material.index.catalogued_n(nm); });
  const auto if_k_measured = [&](auto quantity) {
    return per_wavelength(options.at_nm, [&](double nm) {
      return material.index.has_measured_k(nm) ? Json(quantity(nm)) : Json();
    });
  };
  answer["k"] = if_k_measured([&](double nm) { return material.index.catalogued_k(nm); });
  if (options.thickness_mm)
    answer["internal_transmittance"] = if_k_measured([&](double nm) {
      return std::exp(-material.index.absorption_per_m(nm) * *options.thickness_mm * 1e-3);
    });
  print_material_answer(answer, options);
}

void query_critical(const IndexOptions& options) {
  // The intensity falls to 1/e within one wavelength in vacuum at 4 pi k = 1. Above, no wave propagates
  // inside that could be totally reflected.
  constexpr double kMaxAttenuation = 1;
  const auto critical = [](double n, double k) {
    const bool is_wave = 4 * std::numbers::pi * k < kMaxAttenuation;
    return n > 1 && is_wave ? Json(std::asin(1 / n) / kDegree) : Json();
  };
  print_material_answer(angles(find_surface(options.name, options.at_nm), options, critical), options);
}

void query_brewster(const IndexOptions& options) {
  // Reflectance that counts as zero, since the small k of glass causes it.
  constexpr double kNegligible = 1e-9;
  const NamedIndex material = find_surface(options.name, options.at_nm);
  const auto polarising_angle = [](double n, double k) {
    return k > 0 ? min_p_angle_deg(n, k) : std::atan(n) / kDegree;
  };
  Json answer = angles(material, options, polarising_angle);
  for (std::size_t i = 0; i < options.at_nm.size(); ++i) {
    const double min_rp =
        reflect_from_air(material.index, {}, options.at_nm[i], answer["angle_deg"][i]).power.Rp;
    answer["kind"].push_back(min_rp < kNegligible ? "Brewster" : "pseudo-Brewster");
    answer["Rp"].push_back(min_rp);
  }
  print_material_answer(answer, options);
}

void query_reflectance(const ReflectanceOptions& options) {
  const NamedIndex material = find_surface(options.name, options.at_nm);
  const Coating coating = parse_coating(options.coating, options.at_nm);
  const auto rows = [&](auto quantity) {
    return per_wavelength(options.at_nm, [&](double nm) {
      Json row = Json::array();
      for (const double angle : options.angles_deg)
        row.push_back(quantity(reflect_from_air(material.index, coating, nm, angle)));
      return row;
    });
  };
  Json answer;
  answer["name"] = material.name;
  answer["medium"] = kAmbientMedium;
  answer["angle_deg"] = options.angles_deg;
  answer["wavelength_nm"] = options.at_nm;
  answer["Rs"] = rows([](const auto& f) { return f.power.Rs; });
  answer["Rp"] = rows([](const auto& f) { return f.power.Rp; });
  answer["R"] = rows([](const auto& f) { return f.power.R(); });
  if (!coating.layers.empty()) answer["T"] = rows([](const auto& f) { return f.power.transmitted(); });
  answer["phase_s_deg"] = rows([](const auto& f) { return phase_deg(f.amplitudes.s); });
  answer["phase_p_deg"] = rows([](const auto& f) { return phase_deg(f.amplitudes.p); });
  print_material_answer(answer, options);
}

void query_prism(const PrismOptions& options) {
  const NamedIndex material = find_surface(options.name, options.at_nm);
  const auto column = [&](auto quantity) {
    return per_wavelength(options.at_nm, [&](double nm) {
      if (material.index.k(nm) > kLargestGlassK) return Json();
      const double n = material.index.n(nm);
      const auto passage = options.incidence_deg ? prism_passage(n, options.apex_deg, *options.incidence_deg)
                                                 : prism_minimum(n, options.apex_deg);
      return passage ? Json(quantity(*passage)) : Json();
    });
  };
  Json answer;
  answer["name"] = material.name;
  answer["medium"] = kAmbientMedium;
  answer["apex_deg"] = options.apex_deg;
  answer["wavelength_nm"] = options.at_nm;
  answer["n"] = per_wavelength(options.at_nm, [&](double nm) { return material.index.n(nm); });
  answer["deviation_deg"] = column([](const PrismPassage& p) { return p.deviation_deg; });
  answer["incidence_deg"] = column([](const PrismPassage& p) { return p.incidence_deg; });
  answer["Ts"] = column([](const PrismPassage& p) { return p.Ts; });
  answer["Tp"] = column([](const PrismPassage& p) { return p.Tp; });
  print_material_answer(answer, options);
}

}  // namespace abbe::cli
