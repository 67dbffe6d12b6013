#include "importers/shared/spectra.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "importers/shared/materials.h"
#include "io/text.h"
#include "spectral/colorimetry.h"
#include "spectral/library.h"

namespace abbe::importers {
namespace {

constexpr double kSodiumLine = 589.3;  // Wavelength of a single index [nm].

template <typename... F>
struct Cases : F... {
  using F::operator()...;
};
template <typename... F>
Cases(F...) -> Cases<F...>;

bool is_grey(const LinearRgb& rgb) {
  return rgb[0] == rgb[1] && rgb[1] == rgb[2];
}

spec::Curve curve(decltype(spec::Curve::value) value, const SourcePosition& where) {
  spec::Curve curve;
  curve.value = std::move(value);
  curve.where = where;
  return curve;
}

spec::CurveFormula table_of(const Samples& samples, const SourcePosition& where, SceneImporter& importer) {
  importer.reserve_values(2 * samples.nm.size());
  return {spec::TableCurve{samples.nm, samples.values, samples.outside, where}};
}

void note_colour(const SourcePosition& where, SceneImporter& importer) {
  importer.note(where,
                "a colour does not determine a spectrum: a smooth one with that colour under D65 is used; "
                "prefer a measured one");
}

// Luminance of the colour relative to white.
double luminance_of(const LinearRgb& rgb) {
  if (is_grey(rgb)) return rgb[0];
  Diagnostics diagnostics;
  const auto d65 = load_illuminant("D65", {}, diagnostics);
  if (!d65) throw Error(ErrorCode::input, "illuminant D65", diagnostics.text());
  return tristimulus(d65->curve, rgb_spectrum(rgb), Observer::cie1931)[1] / 100;
}

spec::Curve scaled_curve(spec::Curve given, double factor) {
  if (factor == 1) return given;
  const SourcePosition where = given.where;
  return curve(spec::CurveFormula{spec::Scaled{factor, std::make_shared<spec::Curve>(std::move(given))}},
               where);
}

spec::Spectrum spectrum(spec::Curve curve) {
  spec::Spectrum result;
  static_cast<spec::Curve&>(result) = std::move(curve);
  return result;
}

// n or k as a number or as samples. The samples of a colour are at least kMinIndex, since tables require n >
// 0.
Spectrum part_of_index(const Spectrum& given, const SourcePosition& where, SceneImporter& importer) {
  constexpr double kMinIndex = 1e-6;
  if (const auto* rgb = std::get_if<LinearRgb>(&given)) {
    if (is_grey(*rgb)) return (*rgb)[0];
    if (*std::ranges::min_element(*rgb) < 0)
      importer.refuse(where, fmt::format("n and k must not be negative (got {})", fmt::join(*rgb, ", ")));
    note_colour(where, importer);
    Samples samples = samples_of(*rgb);
    for (double& value : samples.values) value = std::max(value, kMinIndex);
    return samples;
  }
  if (std::holds_alternative<Temperature>(given) || std::holds_alternative<ShippedTable>(given))
    importer.refuse(where, "n and k are numbers, colours or samples (got the spectrum of a light)");
  return given;
}

// Table of n and k at all wavelengths of either.
spec::TableIor index_table(const Spectrum& n, const Spectrum& k, SceneImporter& importer) {
  spec::TableIor table;
  std::vector<double>& all = table.wavelength_nm;
  for (const Spectrum* part : {&n, &k})
    if (const auto* samples = std::get_if<Samples>(part))
      all.insert(all.end(), samples->nm.begin(), samples->nm.end());
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  importer.reserve_values(3 * all.size());
  const auto at_all = [&all](const Spectrum& of) {
    const auto* samples = std::get_if<Samples>(&of);
    const Curve curve = samples ? table_curve(samples->nm, samples->values, Outside::clamp)
                                : Curve(number_of(of).value_or(0));
    std::vector<double> values;
    for (const double nm : all) values.push_back(curve(nm));
    return values;
  };
  table.n = at_all(n);
  table.k = at_all(k);
  return table;
}

ImportedLightSpectrum coloured_light(const LinearRgb& rgb, double y, const SourcePosition& where,
                                     SceneImporter& importer) {
  ImportedLightSpectrum light;
  light.photometric = kLuminousEfficacy * y * luminance_of(rgb);
  if (is_grey(rgb)) {
    light.emission.spectrum = spec::Illuminant{{{"D65"}, where}};
    return light;
  }
  note_colour(where, importer);
  const std::vector<spec::Curve> factors{curve(std::string("D65"), where),
                                         curve(table_of(samples_of(rgb), where, importer), where)};
  light.emission.spectrum = spectrum(curve(spec::CurveFormula{spec::Product{{factors}}}, where));
  return light;
}

std::vector<std::string> words_of(std::string line) {
  line.resize(std::min(line.find('#'), line.size()));
  std::ranges::replace_if(
      line, [](char c) { return c == '\t' || c == '\r' || c == ','; }, ' ');
  std::vector<std::string> words;
  for (std::string& word : split(line, ' '))
    if (!word.empty()) words.push_back(std::move(word));
  return words;
}

}  // namespace

std::optional<Samples> checked(Samples samples, const SourcePosition& where, SceneImporter& importer) {
  if (samples.nm.size() < 2)
    return importer.fail(where,
                         fmt::format("a spectrum needs two samples or more (got {})", samples.nm.size()));
  const auto step = std::ranges::adjacent_find(samples.nm, std::greater_equal<>());
  if (step == samples.nm.end()) return samples;
  return importer.fail(where,
                       fmt::format("wavelengths must ascend (got {} nm after {} nm)", *(step + 1), *step));
}

std::optional<Samples> samples_of_pairs(const std::vector<double>& pairs, const SourcePosition& where,
                                        SceneImporter& importer) {
  Samples samples{{}, {}, Outside::zero};
  for (std::size_t i = 0; i < pairs.size(); i += 2) {
    samples.nm.push_back(pairs[i]);
    samples.values.push_back(pairs[i + 1]);
  }
  return checked(std::move(samples), where, importer);
}

Samples samples_of(const LinearRgb& rgb) {
  constexpr double kLow = 380;
  constexpr double kHigh = 780;
  constexpr double kStep = 5;
  constexpr double kDigits = 1e6;
  const Curve mixture = rgb_spectrum(rgb);
  Samples samples;
  for (double nm = kLow; nm <= kHigh; nm += kStep) {
    samples.nm.push_back(nm);
    samples.values.push_back(std::round(mixture(nm) * kDigits) / kDigits);
  }
  return samples;
}

spec::Curve curve_of(const Spectrum& given, const SourcePosition& where, SceneImporter& importer) {
  const Cases cases{
      [&](double value) { return curve(value, where); },
      [&](const LinearRgb& rgb) {
        if (is_grey(rgb)) return curve(rgb[0], where);
        note_colour(where, importer);
        return curve(table_of(samples_of(rgb), where, importer), where);
      },
      [&](const Samples& samples) { return curve(table_of(samples, where, importer), where); },
      [&](const Temperature& body) {
        return scaled_curve(curve(spec::CurveFormula{spec::Blackbody{{body.K}}}, where), body.factor);
      },
      [&](const ShippedTable& table) { return scaled_curve(curve(table.name, where), table.factor); }};
  return std::visit(cases, given);
}

spec::Texture colours_of(spec::TextureFile file, bool linear, const SourcePosition& where,
                         SceneImporter& importer) {
  importer.reserve_values(kValuesPerItem, file.image.value.size());
  if (!linear || !holds_codes(file.image.value)) return {std::move(file), spec::Rgb{{{true}, where}}};
  note_colour(where, importer);
  const Samples red = samples_of({1, 0, 0});
  const Samples green = samples_of({0, 1, 0});
  // The remainder, so that white is exactly 1.
  Samples blue = red;
  for (std::size_t i = 0; i < blue.values.size(); ++i) blue.values[i] = 1 - red.values[i] - green.values[i];
  spec::Weights weights;
  weights.where = where;
  weights.value = {{"R", curve(table_of(red, where, importer), where), where},
                   {"G", curve(table_of(green, where, importer), where), where},
                   {"B", curve(table_of(blue, where, importer), where), where}};
  return {std::move(file), std::move(weights)};
}

Samples mapped(const Samples& samples, const std::function<double(double)>& function) {
  constexpr double kStep = 5;
  const Curve given = table_curve(samples.nm, samples.values, Outside::clamp);
  Samples mapped{samples.nm, {}, samples.outside};
  for (double nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; nm += kStep)
    if (nm > samples.nm.front() && nm < samples.nm.back()) mapped.nm.push_back(nm);
  std::ranges::sort(mapped.nm);
  mapped.nm.erase(std::unique(mapped.nm.begin(), mapped.nm.end()), mapped.nm.end());
  for (const double nm : mapped.nm) mapped.values.push_back(function(given(nm)));
  return mapped;
}

Samples extend_constant(Samples samples, double outside_value) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  if (std::exchange(samples.outside, Outside::clamp) != Outside::zero) return samples;
  const double before = std::nextafter(samples.nm.front(), -kFar);
  const double behind = std::nextafter(samples.nm.back(), kFar);
  if (before > kMinWavelengthNm) {
    samples.nm.insert(samples.nm.begin(), {kMinWavelengthNm, before});
    samples.values.insert(samples.values.begin(), 2, outside_value);
  }
  if (behind < kMaxWavelengthNm) {
    samples.nm.insert(samples.nm.end(), {behind, kMaxWavelengthNm});
    samples.values.insert(samples.values.end(), 2, outside_value);
  }
  return samples;
}

std::optional<spec::Curve> mapped_curve_of(const Spectrum& given,
                                           const std::function<double(double)>& function,
                                           const SourcePosition& where, SceneImporter& importer) {
  if (const auto* value = std::get_if<double>(&given)) return curve(function(*value), where);
  if (const auto* samples = std::get_if<Samples>(&given))
    return curve(table_of(mapped(*samples, function), where, importer), where);
  const auto* rgb = std::get_if<LinearRgb>(&given);
  if (rgb == nullptr) return std::nullopt;
  if (is_grey(*rgb)) return curve(function((*rgb)[0]), where);
  note_colour(where, importer);
  return curve(table_of(mapped(samples_of(*rgb), function), where, importer), where);
}

Spectrum scaled(Spectrum spectrum, double factor) {
  const Cases cases{[&](double value) -> Spectrum { return value * factor; },
                    [&](LinearRgb rgb) -> Spectrum {
                      for (double& value : rgb) value *= factor;
                      return rgb;
                    },
                    [&](Samples samples) -> Spectrum {
                      for (double& value : samples.values) value *= factor;
                      return samples;
                    },
                    [&](const Temperature& body) -> Spectrum {
                      return Temperature{body.K, body.factor * factor};
                    },
                    [&](ShippedTable table) -> Spectrum {
                      table.factor *= factor;
                      return table;
                    }};
  return std::visit(cases, std::move(spectrum));
}

std::optional<double> number_of(const Spectrum& spectrum) {
  if (const auto* value = std::get_if<double>(&spectrum)) return *value;
  if (const auto* rgb = std::get_if<LinearRgb>(&spectrum))
    return std::accumulate(rgb->begin(), rgb->end(), 0.0) / static_cast<double>(rgb->size());
  if (const auto* samples = std::get_if<Samples>(&spectrum))
    return table_curve(samples->nm, samples->values, samples->outside)(kSodiumLine);
  return std::nullopt;
}

spec::Ior index_of(const Spectrum& n_spectrum, const Spectrum& k_spectrum, const SourcePosition& where,
                   SceneImporter& importer) {
  const Spectrum n = part_of_index(n_spectrum, where, importer);
  const Spectrum k = part_of_index(k_spectrum, where, importer);
  spec::Ior ior;
  ior.where = where;
  const auto* n_samples = std::get_if<Samples>(&n);
  const auto* k_samples = std::get_if<Samples>(&k);
  const bool reflects_all = n_samples == nullptr && number_of(n) == 0;  // For any k.
  if (reflects_all || (n_samples == nullptr && k_samples == nullptr))
    ior.value = spec::MetalIor{{number_of(n).value_or(1), number_of(k).value_or(0)}};
  else
    ior.value = index_table(n, k, importer);
  return ior;
}

ImportedLightSpectrum light_spectrum_of(const Spectrum& given, double y, const SourcePosition& where,
                                        SceneImporter& importer) {
  if (const auto* rgb = std::get_if<LinearRgb>(&given)) return coloured_light(*rgb, y, where, importer);
  ImportedLightSpectrum light;
  light.photometric = kLuminousEfficacy * y;
  if (const auto* table = std::get_if<ShippedTable>(&given))
    light.emission.spectrum = spec::Illuminant{{{table->name}, where}};
  else if (const auto* body = std::get_if<Temperature>(&given))
    light.emission.spectrum = spec::Blackbody{{body->K}};
  else if (std::holds_alternative<double>(given))
    light.emission.spectrum = spec::Illuminant{{{"E"}, where}};
  else
    light.emission.spectrum = spectrum(curve_of(given, where, importer));
  return light;
}

ImportedLightSpectrum absolute_light_spectrum_of(const Spectrum& given, double y, const SourcePosition& where,
                                                 SceneImporter& importer) {
  if (const auto* value = std::get_if<double>(&given))
    return coloured_light({*value, *value, *value}, y, where, importer);
  if (std::holds_alternative<LinearRgb>(given)) return light_spectrum_of(given, y, where, importer);
  ImportedLightSpectrum light;
  const auto* body = std::get_if<Temperature>(&given);
  if (body != nullptr && body->factor == 1)
    light.emission.spectrum = spec::Blackbody{{body->K}};
  else
    light.emission.spectrum = spectrum(curve_of(given, where, importer));
  return light;
}

std::optional<Samples> read_spectrum_file(const std::filesystem::path& file, const SourcePosition& where,
                                          SceneImporter& importer) {
  if (!importer.check_file(file, where)) return std::nullopt;
  const auto source = importer.read(file);
  if (!source) return std::nullopt;
  std::vector<double> pairs;
  for (std::size_t from = 0; from < source->text.size();) {
    const std::size_t end = std::min(source->text.find('\n', from), source->text.size());
    const std::vector<std::string> words = words_of(source->text.substr(from, end - from));
    const auto nm = words.size() == 2 ? parse_number(words[0]) : std::nullopt;
    const auto value = nm ? parse_number(words[1]) : std::nullopt;
    if (value)
      pairs.insert(pairs.end(), {*nm, *value});
    else if (!words.empty())
      return importer.fail({source, from, ""}, "expected a wavelength and a value", ErrorCode::input);
    from = end + 1;
  }
  return samples_of_pairs(pairs, {source, 0, ""}, importer);
}

}  // namespace abbe::importers
