#include <cmath>
#include <limits>

#include <pybind11/stl.h>

#include "io/text.h"
#include "materials/index/library.h"
#include "materials/interface/coating.h"
#include "materials/interface/prism.h"
#include "python/arguments.h"
#include "python/errors.h"
#include "python/gil.h"
#include "python/module.h"
#include "python/numbers.h"
#include "sampling/angle.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Loads the index of a named material, which must have data at all requested wavelengths.
NamedIndex load_index_for(const std::string& name, const Numbers& wavelengths_nm) {
  Diagnostics diagnostics;
  NamedIndex named = accepted(load_index(name, {}, diagnostics), diagnostics);
  require_data_at(named, span_of(wavelengths_nm), "wavelengths_nm");
  return named;
}

// Loads the index of a named material for reflectance, which also needs k at all requested wavelengths.
NamedIndex load_surface_index(const std::string& name, const Numbers& wavelengths_nm) {
  NamedIndex named = load_index_for(name, wavelengths_nm);
  require_k_at(named, span_of(wavelengths_nm), "wavelengths_nm");
  return named;
}

py::object ior(const std::string& name, const Numbers& wavelengths_nm) {
  const NamedIndex named = load_index_for(name, wavelengths_nm);
  return map(wavelengths_nm, [&](double nm) { return named.index.catalogued_n(nm); });
}

py::object extinction(const std::string& name, const Numbers& wavelengths_nm) {
  const NamedIndex named = load_index_for(name, wavelengths_nm);
  return map(wavelengths_nm,
             [&](double nm) { return named.index.has_measured_k(nm) ? named.index.catalogued_k(nm) : kNan; });
}

py::dict material(const std::string& name) {
  const NamedIndex named = load_index_for(name, Numbers(0));
  py::dict result;
  result["name"] = named.name;
  result["source"] = named.source;
  result["medium"] = named.index.medium() == IndexMedium::vacuum ? "vacuum" : "air";
  result["low_nm"] = named.index.low_nm();
  result["high_nm"] = named.index.high_nm();
  const auto& k = named.index.k_range();
  result["k_low_nm"] = k ? std::optional(k->low_nm) : std::nullopt;
  result["k_high_nm"] = k ? std::optional(k->high_nm) : std::nullopt;
  return result;
}

// Coating of layers (material, thickness in nm), from outside inwards.
Coating coating_of(const std::vector<std::pair<std::string, Real>>& layers, const Numbers& wavelengths_nm) {
  Coating coating;
  for (const auto& [name, thickness_nm] : layers) {
    if (!kFilmThickness.contains(thickness_nm) || coating.layers.size() == Coating::kMaxMaterials)
      refuse_argument("coating", "got {} nm of \"{}\", allowed up to {} layers of {} nm", thickness_nm.value,
                      name, Coating::kMaxMaterials, kFilmThickness.text());
    NamedIndex named = load_surface_index(name, wavelengths_nm);
    coating.layers.push_back({static_cast<std::uint32_t>(coating.materials.size()), thickness_nm});
    coating.materials.push_back({std::move(named.name), std::move(named.index)});
  }
  return coating;
}

// Rs and Rp for light incident from air.
py::tuple reflectance(const std::string& name, const Numbers& wavelengths_nm, const Numbers& angles_deg,
                      const std::vector<std::pair<std::string, Real>>& layers) {
  const NamedIndex named = load_surface_index(name, wavelengths_nm);
  const Coating coating = coating_of(layers, wavelengths_nm);
  for (const double angle : span_of(angles_deg))
    if (!(angle >= 0 && angle <= 90)) refuse_argument("angle_deg", "got {}, allowed [0, 90]", angle);
  const auto [nm, angle] = broadcast(wavelengths_nm, angles_deg, "wavelengths_nm", "angle_deg");
  Numbers rs = empty_like(nm);
  Numbers rp = empty_like(nm);
  double* const s = rs.mutable_data();
  double* const p = rp.mutable_data();
  {
    const GilReleased released;
    for (std::size_t i = 0; i < span_of(nm).size(); ++i) {
      const double at = span_of(nm)[i];
      const double cos_i = span_of(angle)[i] == 90 ? 0 : std::cos(span_of(angle)[i] * kDegree);
      const FresnelPower<double> power =
          coated_power(coating, at, named.index.n(at), named.index.k(at), cos_i, false);
      s[i] = power.Rs;
      p[i] = power.Rp;
    }
  }
  return py::make_tuple(rs[py::tuple()], rp[py::tuple()]);
}

py::object prism_deviation(const std::string& name, const Numbers& wavelengths_nm, Real apex_deg,
                           std::optional<Real> incidence_deg) {
  if (!(apex_deg > 0 && apex_deg < 180))
    refuse_argument("apex_deg", "got {}, allowed (0, 180)", apex_deg.value);
  if (incidence_deg && !(std::abs(*incidence_deg) < 90))
    refuse_argument("incidence_deg", "got {}, allowed (-90, 90)", incidence_deg->value);
  const NamedIndex named = load_surface_index(name, wavelengths_nm);
  return map(wavelengths_nm, [&](double nm) {
    if (named.index.k(nm) > kLargestGlassK) return kNan;
    const double n = named.index.n(nm);
    const auto passage =
        incidence_deg ? prism_passage(n, apex_deg, *incidence_deg) : prism_minimum(n, apex_deg);
    return passage ? passage->deviation_deg : kNan;
  });
}

}  // namespace

void add_materials(py::module_& module) {
  module.def("ior", ior, py::arg("name"), py::arg("wavelengths_nm"),
             "Returns the real refractive index n of a material at wavelengths in standard air, as "
             "catalogued. It is relative to air or vacuum; `material(name)` returns which.\n\nNames are "
             "those of `names(\"material\")` and `names(\"glass\")`, or files. Raises InputError for an "
             "unknown name, and UsageError for a wavelength without data or outside [300, 1100] nm.");
  module.def("extinction", extinction, py::arg("name"), py::arg("wavelengths_nm"),
             "Returns the extinction coefficient k of a material, the imaginary part of its index n + ik, as "
             "catalogued; NaN where it is not measured. Raises as `ior` does.");
  module.def("material", material, py::arg("name"),
             "Returns a dict that describes the data of a material: its full name, their source, the medium "
             "that the index is relative to, and the wavelength ranges of n (`low_nm`, `high_nm`) and k "
             "(`k_low_nm`, `k_high_nm`, None without measured k).");
  module.def("reflectance", reflectance, py::arg("name"), py::arg("wavelengths_nm"),
             py::arg("angle_deg") = 0.0, py::arg("coating") = std::vector<std::pair<std::string, double>>(),
             "Returns (Rs, Rp), the reflectance of a smooth surface in air for s and p polarisation, by "
             "Fresnel's formulas.\n\nWavelengths and angles of incidence are broadcast against one another. "
             "`coating` lists thin films (material, thickness in nm) from outside inwards. Raises as `ior` "
             "does, and UsageError if the reflectance depends on a k that is not measured.");
  module.def("prism_deviation", prism_deviation, py::arg("name"), py::arg("wavelengths_nm"),
             py::arg("apex_deg") = 60.0, py::arg("incidence_deg") = py::none(),
             "Returns the deviation of light by a prism in air in degrees: the minimum deviation, or that at "
             "one angle of incidence. NaN if the light is totally reflected or the material is opaque (k "
             "above 1e-3). Raises as `ior` does.");
}

}  // namespace abbe::python
