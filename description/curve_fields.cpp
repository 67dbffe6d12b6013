#include "description/curve.h"

namespace abbe::spec {
namespace {

using namespace schema;

// Wavelengths of a table's samples: wide enough for tables beyond the rendered range, too high for
// micrometres.
constexpr Range kTableWavelength{100, 1e5};
constexpr Range kLineWidth{1e-3, kMaxWavelengthNm - kMinWavelengthNm};

}  // namespace

static const Fields& fields(Tag<TableCurve>) {
  static const Fields kFields = describe<TableCurve>(
      "table_curve", "Samples with straight lines between them.",
      {field("wavelength_nm", &TableCurve::wavelength_nm, numbers(kTableWavelength),
             "Strictly ascending wavelengths."),
       field("values", &TableCurve::values, numbers(kValue), "As many values."),
       field("outside", &TableCurve::outside, word<Outside>("rule for outside the table", {"clamp", "zero"}),
             "What holds before the first and after the last sample.")});
  return kFields;
}

static const Fields& fields(Tag<Band>) {
  static const Fields kFields =
      describe<Band>("band", "A box.",
                     {field("band", &Band::ends, vector<std::array<double, 2>>(kWavelength),
                            "[low, high) in nm, and zero elsewhere."),
                      field("value", &Band::value, number(kValue), "Height of the band.").or_default()});
  return kFields;
}

static const Fields& fields(Tag<Gaussian>) {
  static const Fields kFields = describe<Gaussian>(
      "gaussian", "peak x 2^(-(2 (wavelength - center)/fwhm)^2).",
      {field("center_nm", &Gaussian::center_nm, number(kWavelength), "Where it is highest."),
       field("fwhm_nm", &Gaussian::fwhm_nm, number(kLineWidth), "Full width at half maximum."),
       field("peak", &Gaussian::peak, number(kValue), "Its height.").or_default()});
  return kFields;
}

static const Fields& fields(Tag<Line>) {
  static const Fields kFields =
      describe<Line>("line", "A spectral line, which spreads its power evenly over its width.",
                     {field("nm", &Line::nm, number(kWavelength), "Its middle."),
                      field("width_nm", &Line::width_nm, number(kLineWidth), "Its width."),
                      field("power", &Line::power, number(kPower), "Its integral.")});
  return kFields;
}

static const Fields& fields(Tag<Scaled>) {
  static const Fields kFields =
      describe<Scaled>("scaled", "",
                       {field("of", &Scaled::of, curve(), "A curve that `scale` multiplies."),
                        field("scale", &Scaled::scale, number(kValue), "Factor of the curve `of`.")});
  return kFields;
}

const Fields& fields(Tag<CurveFormula>) {
  static const Fields kFields = describe<CurveFormula>(
      "curve_formula", "A curve given by a formula.",
      {one_of(&CurveFormula::of, under<TableCurve>("table", thing<TableCurve>(), "Samples of the curve."),
              beside<Band>("band"), under<Gaussian>("gaussian", thing<Gaussian>(), "A bell."),
              under<Lines>("lines", lines(), "Spectral lines."),
              under<Blackbody>("blackbody_K", blackbody_K(),
                               "Planck's spectral radiance at this temperature [K]."),
              under<Daylight>("daylight_K", daylight_K(),
                              "CIE daylight of this correlated colour temperature [K], relative."),
              under<Product>("product", list<Curve>(curve(), "curves", 1), "The product of all."),
              under<Sum>("sum", list<Curve>(curve(), "curves", 1), "The sum of all."),
              beside<Scaled>("of"))});
  return kFields;
}

Kind lines() {
  return list<Line>(thing<Line>(), "lines", 1);
}
Kind blackbody_K() {
  return number({100, 1e6});
}
Kind daylight_K() {
  return number({4000, 25000});
}

Kind curve() {
  return forms<Curve::Wrapped>(
      "curve", "a curve: a number, a name or an object", form<double>(Json::number, number(kValue)),
      form<std::string>(Json::text, text()), form<CurveFormula>(Json::object, thing<CurveFormula>()));
}

}  // namespace abbe::spec
