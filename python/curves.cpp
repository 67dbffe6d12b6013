#include <algorithm>
#include <cmath>

#include <pybind11/stl.h>

#include "calibration/chart/delta_e.h"
#include "io/table.h"
#include "materials/index/library.h"
#include "python/arguments.h"
#include "python/errors.h"
#include "python/module.h"
#include "python/numbers.h"
#include "report/image_difference.h"
#include "sensor/response/channel.h"
#include "spectral/curve_use.h"
#include "spectral/library.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

Observer observer_of(const std::string& name) {
  return choice("observer", name, {"1931", "1964"}) == 0 ? Observer::cie1931 : Observer::cie1964;
}

py::object values_of(const std::string& name, const Curve& curve, const Numbers& wavelengths_nm) {
  require_between(name, kMinWavelengthNm, kMaxWavelengthNm, span_of(wavelengths_nm), "wavelengths_nm");
  return map(wavelengths_nm, [&](double nm) { return curve(nm); });
}

// The range of wavelengths that a table must cover.
NeededRange needed_at(const Numbers& wavelengths_nm) {
  NeededRange needed;
  for (const double nm : span_of(wavelengths_nm))
    needed = {std::min(needed.low_nm, nm), std::max(needed.high_nm, nm)};
  return needed;
}

Curve named_illuminant(const std::string& name, NeededRange needed = {}) {
  Diagnostics diagnostics;
  return accepted(load_illuminant(name, {}, diagnostics, needed), diagnostics).curve;
}

Curve named_reflectance(const std::string& name) {
  Diagnostics diagnostics;
  return accepted(load_curve(kReflectanceUse, name, {}, diagnostics), diagnostics).curve;
}

py::object illuminant(const std::string& name, const Numbers& wavelengths_nm) {
  return values_of(name, named_illuminant(name, needed_at(wavelengths_nm)), wavelengths_nm);
}

py::object curve(const std::string& kind, const std::string& name, const Numbers& wavelengths_nm) {
  if (kind == kIlluminantUse.folder) return illuminant(name, wavelengths_nm);
  Diagnostics diagnostics;
  const auto table = load_curve(kind, name, {}, diagnostics, needed_at(wavelengths_nm));
  return values_of(name, accepted(table, diagnostics).curve, wavelengths_nm);
}

py::dict observer(const std::string& name, const Numbers& wavelengths_nm) {
  const ColorMatching& matching = color_matching(observer_of(name));
  py::dict values;
  values["x"] = values_of(name, matching.x, wavelengths_nm);
  values["y"] = values_of(name, matching.y, wavelengths_nm);
  values["z"] = values_of(name, matching.z, wavelengths_nm);
  return values;
}

py::dict camera(const std::string& name, const Numbers& wavelengths_nm, const std::string& response) {
  Diagnostics diagnostics;
  py::dict values;
  const std::optional<ResponseKind> kind = response_of("response", response);
  for (const Channel& channel : accepted(load_camera(name, {}, diagnostics, kind), diagnostics))
    values[py::str(channel.name)] = values_of(name, channel.weight, wavelengths_nm);
  return values;
}

// A spectrum given by samples, linear between them.
Curve sampled(const Numbers& wavelengths_nm, const Numbers& values) {
  const std::span<const double> nm = span_of(wavelengths_nm);
  if (nm.size() != span_of(values).size() || nm.size() < 2)
    refuse_argument("spectrum", "got {} wavelengths and {} values, allowed equal numbers of two or more",
                    nm.size(), span_of(values).size());
  for (std::size_t i = 0; i < nm.size(); ++i)
    if (!std::isfinite(nm[i]) || !std::isfinite(span_of(values)[i]) || (i > 0 && !(nm[i] > nm[i - 1])))
      refuse_argument("spectrum", "got {} at {} nm, allowed finite values at ascending wavelengths",
                      span_of(values)[i], nm[i]);
  if (const auto fault = range_fault(nm.front(), nm.back()))
    throw Error(ErrorCode::usage, "spectrum", *fault);
  return table_curve(nm, span_of(values), Outside::zero);
}

// The curve for a name, or for wavelengths and values within the range that `use` allows.
template <typename Load>
Curve curve_of(const py::handle& spectrum, const char* name, const CurveUse& use, Load load) {
  if (py::isinstance<py::str>(spectrum)) return load(encoded(spectrum));
  const auto [nm, values] =
      argument<std::pair<Numbers, Numbers>>(spectrum, name, "a name, or wavelengths and values");
  Curve curve = sampled(nm, values);
  if (const auto fault = value_fault(curve, use.allowed)) throw Error(ErrorCode::usage, name, *fault);
  return curve;
}

py::dict color(const py::object& illuminant, const py::object& reflectance, const std::string& observer,
               const std::string& range_name) {
  const SumRange range =
      choice("range", range_name, {"360-830", "380-780"}) == 0 ? SumRange{} : kVisibleRange;
  const Observer eye = observer_of(observer);
  const Curve light = curve_of(illuminant, "illuminant", kIlluminantUse,
                               [](const std::string& name) { return named_illuminant(name); });
  const Curve surface = reflectance.is_none()
                            ? Curve(1.0)
                            : curve_of(reflectance, "reflectance", kReflectanceUse, named_reflectance);
  const XYZ xyz = tristimulus(light, surface, eye, range);
  const XYZ white = tristimulus(light, Curve(1.0), eye, range);
  if (!std::isfinite(white[1]))
    throw Error(ErrorCode::input, "illuminant",
                "has no light that an observer sees, so that it has no colour");
  py::dict result;
  result["XYZ"] = py::array(py::cast(xyz));
  result["xy"] = py::array(py::cast(chromaticity(xyz)));
  result["Lab"] = py::array(py::cast(xyz_to_lab(xyz, white)));
  return result;
}

py::object lab_difference(const Numbers& lab1, const Numbers& lab2, const std::string& formula) {
  const auto how = static_cast<DeltaE>(choice("formula", formula, {"2000", "94", "76", "cam16", "itp"}));
  const auto [standard, sample] = broadcast(lab1, lab2, "lab1", "lab2");
  const py::ssize_t axes = standard.ndim();
  if (axes == 0 || standard.shape(axes - 1) != 3)
    throw Error(ErrorCode::usage, "lab1", "expected arrays whose last axis is L*, a*, b*");
  Numbers differences(std::vector<py::ssize_t>(standard.shape(), standard.shape() + axes - 1));
  const auto at = [](const Numbers& labs, py::ssize_t i) {
    const double* lab = labs.data() + 3 * i;
    return Lab{lab[0], lab[1], lab[2]};
  };
  for (py::ssize_t i = 0; i < differences.size(); ++i)
    differences.mutable_data()[i] = delta_e(how, at(standard, i), at(sample, i));
  return differences[py::tuple()];
}

std::vector<std::string> names(const std::string& kind) {
  if (kind == "material") return index_names();
  if (kind == "glass") return glass_names();
  const std::vector<std::string> kinds{"material", "glass",  "illuminant", "reflectance",
                                       "camera",   "filter", "observer"};
  if (std::ranges::find(kinds, kind) == kinds.end())
    throw Error(ErrorCode::usage, "kind", unknown_name("kind", kind, kinds));
  return table_names(kind);
}

}  // namespace

void add_curves(py::module_& module) {
  module.def("names", names, py::arg("kind"),
             "Returns the names of all tables of a kind: material, glass, illuminant, reflectance, camera, "
             "filter or observer. Raises UsageError for another kind.");
  module.def("illuminant", illuminant, py::arg("name"), py::arg("wavelengths_nm"),
             "Returns the relative power of an illuminant at wavelengths, in the unit of its table. "
             "\"blackbody:3000\" and \"daylight:6500\" are computed for that temperature in K. Raises "
             "InputError for an unknown name and for a wavelength outside the table, and UsageError for a "
             "wavelength outside [300, 1100] nm.");
  module.def("curve", curve, py::arg("kind"), py::arg("name"), py::arg("wavelengths_nm"),
             "Returns a measured curve, such as a reflectance, at wavelengths. The kinds are those of "
             "`names` except material and glass. Raises as `illuminant` does.");
  module.def("observer", observer, py::arg("name") = "1931", py::kw_only(), py::arg("wavelengths_nm"),
             "Returns the colour-matching functions of the CIE standard observer of 1931 or 1964 at "
             "wavelengths, as a "
             "dict of x, y, z. Raises as `illuminant` does.");
  module.def("camera", camera, py::arg("name"), py::arg("wavelengths_nm"), py::kw_only(),
             py::arg("response") = "",
             "Returns the responses of a measured camera at wavelengths as a dict by channel: relative to "
             "energy, or electrons per J for a quantum efficiency. `response` states the quantity that the "
             "camera's curves multiply, \"energy\" or \"quantum\". Without it, columns named QE are quantum "
             "efficiencies, and all others are responses to energy. Raises as `illuminant` does, and "
             "InputError for quantum efficiencies in percent.");
  module.def(
      "color", color, py::arg("illuminant"), py::arg("reflectance") = py::none(),
      py::arg("observer") = "1931", py::kw_only(), py::arg("range") = "360-830",
      "Returns the colour of a reflectance, or of the perfect diffuser, as a dict of XYZ (Y = 100 for the "
      "perfect diffuser), xy and Lab. The sums run over every nanometre from 360 to 830 nm, or, with "
      "range=\"380-780\", over that range, as in other programs.\n\nIlluminant and reflectance are names, or "
      "pairs of wavelengths in nm and values, linear between them and 0 outside. Raises InputError for an "
      "unknown name and for a table of reflectances outside [0, 1]. Raises UsageError for a pair with "
      "reflectances outside [0, 1], with a negative illuminant, or without wavelengths from 300 to 1100 nm.");
  module.def("delta_e", lab_difference, py::arg("lab1"), py::arg("lab2"), py::arg("formula") = "2000",
             "Returns the CIE colour differences between arrays whose last axis is L*, a*, b*; the first "
             "array is the standard. The formula is that of 2000, 94 or 76, or cam16 (CAM16-UCS) or itp "
             "(BT.2124), which both assume D65. Values that are not finite give NaN.");
}

}  // namespace abbe::python
