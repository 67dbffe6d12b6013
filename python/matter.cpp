#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "io/text.h"
#include "materials/index/library.h"
#include "materials/interface/coating.h"
#include "materials/interface/film_thickness.h"
#include "materials/interface/prism.h"
#include "python/arrays.h"
#include "python/errors.h"
#include "python/lock.h"
#include "python/query.h"
#include "sampling/angle.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The material of that name, which must hold at all wavelengths asked for.
NamedIndex find(const std::string& name, const Numbers& wavelengths_nm) {
  Diagnostics diagnostics;
  NamedIndex found = accepted(load_index(name, {}, diagnostics), diagnostics);
  require_data_at(found, all(wavelengths_nm), "wavelengths_nm");
  return found;
}

// The same, to tell what its surface reflects.
NamedIndex find_surface(const std::string& name, const Numbers& wavelengths_nm) {
  NamedIndex found = find(name, wavelengths_nm);
  require_k_at(found, all(wavelengths_nm), "wavelengths_nm");
  return found;
}

py::object ior(const std::string& name, const Numbers& wavelengths_nm) {
  const NamedIndex matter = find(name, wavelengths_nm);
  return each(wavelengths_nm, [&](double nm) { return matter.index.catalogued_n(nm); });
}

py::object extinction(const std::string& name, const Numbers& wavelengths_nm) {
  const NamedIndex matter = find(name, wavelengths_nm);
  return each(wavelengths_nm,
              [&](double nm) { return matter.index.knows_k(nm) ? matter.index.catalogued_k(nm) : kNan; });
}

py::dict material(const std::string& name) {
  const NamedIndex matter = find(name, Numbers(0));
  py::dict told;
  told["name"] = matter.name;
  told["source"] = matter.source;
  told["medium"] = matter.index.medium() == IndexMedium::vacuum ? "vacuum" : "air";
  told["low_nm"] = matter.index.low_nm();
  told["high_nm"] = matter.index.high_nm();
  const auto& k = matter.index.k_range();
  told["k_low_nm"] = k ? py::object(py::float_(k->low_nm)) : py::none();
  told["k_high_nm"] = k ? py::object(py::float_(k->high_nm)) : py::none();
  return told;
}

// Layers (material, thickness in nm) from outside inwards.
Coating coating_of(const std::vector<std::pair<std::string, Real>>& layers, const Numbers& wavelengths_nm) {
  Coating coating;
  for (const auto& [name, thickness_nm] : layers) {
    if (!kFilmThickness.contains(thickness_nm) || coating.layers.size() == Coating::kMaxMaterials)
      throw Error(ErrorCode::usage, "coating",
                  fmt::format("got {} nm of \"{}\", allowed up to {} layers of {} nm", thickness_nm.value,
                              name, Coating::kMaxMaterials, kFilmThickness.text()));
    NamedIndex matter = find_surface(name, wavelengths_nm);
    coating.layers.push_back({static_cast<std::uint32_t>(coating.materials.size()), thickness_nm});
    coating.materials.push_back({std::move(matter.name), std::move(matter.index)});
  }
  return coating;
}

// Rs and Rp for light from air.
py::tuple reflectance(const std::string& name, const Numbers& wavelengths_nm, const Numbers& angles_deg,
                      const std::vector<std::pair<std::string, Real>>& layers) {
  const NamedIndex matter = find_surface(name, wavelengths_nm);
  const Coating coating = coating_of(layers, wavelengths_nm);
  for (const double angle : all(angles_deg))
    if (!(angle >= 0 && angle <= 90))
      throw Error(ErrorCode::usage, "angle_deg", fmt::format("got {}, allowed [0, 90]", angle));
  const auto [nm, angle] = broadcast(wavelengths_nm, angles_deg, "wavelengths_nm", "angle_deg");
  Numbers rs = alike(nm);
  Numbers rp = alike(nm);
  double* const s = rs.mutable_data();
  double* const p = rp.mutable_data();
  {
    const Released released;
    for (std::size_t i = 0; i < all(nm).size(); ++i) {
      const double at = all(nm)[i];
      const double cos_i = all(angle)[i] == 90 ? 0 : std::cos(all(angle)[i] * kDegree);
      const FresnelPower<double> power =
          coated_power(coating, at, matter.index.n(at), matter.index.k(at), cos_i, false);
      s[i] = power.Rs;
      p[i] = power.Rp;
    }
  }
  return py::make_tuple(rs[py::tuple()], rp[py::tuple()]);
}

py::object prism_deviation(const std::string& name, const Numbers& wavelengths_nm, Real apex_deg,
                           std::optional<Real> incidence_deg) {
  if (!(apex_deg > 0 && apex_deg < 180))
    throw Error(ErrorCode::usage, "apex_deg", fmt::format("got {}, allowed (0, 180)", apex_deg.value));
  if (incidence_deg && !(std::abs(*incidence_deg) < 90))
    throw Error(ErrorCode::usage, "incidence_deg",
                fmt::format("got {}, allowed (-90, 90)", incidence_deg->value));
  const NamedIndex matter = find_surface(name, wavelengths_nm);
  return each(wavelengths_nm, [&](double nm) {
    if (matter.index.k(nm) > kLargestGlassK) return kNan;
    const double n = matter.index.n(nm);
    const auto passage =
        incidence_deg ? prism_passage(n, apex_deg, *incidence_deg) : prism_minimum(n, apex_deg);
    return passage ? passage->deviation_deg : kNan;
  });
}

}  // namespace

void add_matter(py::module_& module) {
  module.def(
      "ior", ior, py::arg("name"), py::arg("wavelengths_nm"),
      "Returns the real refractive index n of a material at wavelengths in standard air, as catalogued: "
      "relative "
      "to air or vacuum, as `material(name)` tells.\n\nNames are those of `names(\"material\")` and "
      "`names(\"glass\")`, or files. Raises InputError for an unknown name and UsageError for a wavelength "
      "without data or outside [300, 1100] nm.");
  module.def("extinction", extinction, py::arg("name"), py::arg("wavelengths_nm"),
             "Returns the extinction coefficient k of a material, the imaginary part of its index n + ik, as "
             "catalogued; NaN where it is not measured. Raises as `ior` does.");
  module.def(
      "material", material, py::arg("name"),
      "Returns a dict of what is known of a material: its full name, the source of its data, the medium its "
      "index is relative to, and the wavelengths between which n (`low_nm`, `high_nm`) and k (`k_low_nm`, "
      "`k_high_nm`, None where no k is measured) hold.");
  module.def(
      "reflectance", reflectance, py::arg("name"), py::arg("wavelengths_nm"), py::arg("angle_deg") = 0.0,
      py::arg("coating") = std::vector<std::pair<std::string, double>>(),
      "Returns (Rs, Rp), the reflectance of a smooth surface for light from air, polarised across and in the "
      "plane of incidence, by Fresnel's formulas.\n\nWavelengths and angles of incidence are broadcast "
      "against one another. `coating` lists films (material, thickness in nm) from outside inwards. Raises "
      "as "
      "`ior` does, and UsageError too where k is not measured and the reflectance hangs on it.");
  module.def("prism_deviation", prism_deviation, py::arg("name"), py::arg("wavelengths_nm"),
             py::arg("apex_deg") = 60.0, py::arg("incidence_deg") = py::none(),
             "Returns by how many degrees a prism in air deviates light: the least deviation, or that at one "
             "angle of incidence; NaN where the light is "
             "totally reflected or the matter lets none through (k above 1e-3). Raises as `ior` does.");
}

}  // namespace abbe::python
