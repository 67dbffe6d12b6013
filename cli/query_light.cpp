#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "calibration/metrics/color_rendering.h"
#include "cli/answer.h"
#include "cli/arguments.h"
#include "cli/output_files.h"
#include "cli/query.h"
#include "develop/radiance.h"
#include "io/atomic_file.h"
#include "io/exr.h"
#include "io/spectral_exr.h"
#include "io/text.h"
#include "report/plot.h"
#include "sensor/response/table_range.h"
#include "spectral/color_temperature.h"
#include "spectral/curve_use.h"
#include "spectral/library.h"
#include "spectral/sources.h"

namespace abbe::cli {
namespace {

// Mean spectral radiance of the requested pixels of a spectral image, linear between the centres of its
// bands: sums over whole nanometres would shift steps. Warns if an observer behind this transmittance would
// see light outside the bands.
Curve image_light_of(const LightOptions& options, const Curve& transmittance, Diagnostics& diagnostics) {
  Inputs inputs(options.max_memory_bytes);
  Image film = read_exr(options.name, &inputs);
  const Crop crop = requested_pixels(film, options.crop);
  const SpectralImage image = spectral_image(std::move(film), options.name);
  for (const Channel& channel : observer_channels(Observer::cie1931))
    check_coverage(image, behind(channel, FilterStack{transmittance}), options.name, diagnostics);
  const std::vector<double> edges = band_edges(image.bands);
  std::vector<Knot> knots{{edges.front(), 0}};
  for (std::size_t b = 0; b < image.bands.size(); ++b) {
    double total = 0;
    for (int y = crop.y0; y < crop.y1; ++y)
      for (int x = crop.x0; x < crop.x1; ++x)
        total += static_cast<double>(
            image.bands[b].radiance[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                    static_cast<std::size_t>(x)]);
    const double pixels = static_cast<double>(crop.x1 - crop.x0) * (crop.y1 - crop.y0);
    const double density = total / pixels / (edges[b + 1] - edges[b]);
    if (!(density >= 0 && std::isfinite(density)))
      throw Error(
          ErrorCode::input, options.name,
          fmt::format(
              "has a radiance that is negative or not finite in the band at {:g} nm (got a mean of {})",
              image.bands[b].center_nm, total / pixels));
    if (b == 0) knots.push_back({edges[b], density});
    knots.push_back({image.bands[b].center_nm, density});
    if (b + 1 == image.bands.size()) knots.push_back({edges[b + 1], density});
  }
  knots.push_back({edges.back(), 0});
  return Curve(std::move(knots));
}

// Product of tabulated spectra.
struct TabulatedLight {
  Curve light{1.0};
  Curve extrapolated_light{1.0};  ///< The same with tables extrapolated by their end values.
  std::vector<NamedCurve> tables;

  // Ignores a table that could not be loaded.
  void add(const std::optional<NamedCurve>& table) {
    if (!table) return;
    light = product(light, table->curve);
    extrapolated_light = product(extrapolated_light, extrapolated(*table));
    tables.push_back(*table);
  }

  // Warns of tables that end inside the range of an observer or of the luminous efficacy. `others` is the
  // product of the factors without tables.
  void check_tables(const Curve& others, Diagnostics& diagnostics) const {
    const std::vector<Channel> observer = observer_channels(Observer::cie1931);
    const Curve radiation = band(kVisibleRange.low_nm, kVisibleRange.high_nm);
    std::vector<NamedResponse> counters = named_responses(observer);
    counters.push_back({"the luminous efficacy of radiation from 380 to 780 nm", &radiation});
    for (const NamedCurve& table : tables)
      check_table_range(table, product(extrapolated_light, others), counters, {}, diagnostics);
  }
};

// Curve of this name, or an empty one after an error.
Curve curve_for(const CurveUse& use, const std::string& name, Diagnostics& diagnostics) {
  const auto curve = load_curve(use, name, {}, diagnostics);
  return curve ? curve->curve : Curve();
}

// Requested light: that of an illuminant or an image, through filters and after reflection.
Curve requested_light(const LightOptions& options) {
  Diagnostics diagnostics;
  TabulatedLight tabulated;
  if (!options.filters.empty())
    for (const std::string& filter : split(options.filters, ','))
      tabulated.add(load_curve(kTransmittanceUse, filter, {}, diagnostics));
  Curve surface(1.0);
  if (!options.reflectance.empty()) surface = curve_for(kReflectanceUse, options.reflectance, diagnostics);
  Curve image_light(1.0);
  if (extension_of(options.name) == ".exr")
    image_light = image_light_of(options, product(tabulated.light, surface), diagnostics);
  else if (options.crop)
    throw Error(ErrorCode::usage, "--crop", "applies to spectral images only");
  else
    tabulated.add(load_illuminant(options.name, {}, diagnostics));
  const Curve others = product(image_light, surface);
  tabulated.check_tables(others, diagnostics);
  check(diagnostics);
  return product(tabulated.light, others);
}

void add_fidelity(Json& answer, const ColorFidelity& fidelity, bool with_samples) {
  answer["Rf"] = fidelity.fidelity;
  answer["Rg"] = fidelity.gamut;
  for (const HueBin& bin : fidelity.bins) {
    answer["Rf_h"].push_back(bin.fidelity);
    answer["Rcs_h"].push_back(bin.chroma_shift);
    answer["Rhs_h"].push_back(bin.hue_shift);
  }
  for (std::size_t i = 0; with_samples && i < fidelity.samples.size(); ++i)
    answer["Rs"][fmt::format("CES{:02}", i + 1)] = fidelity.samples[i];
}

}  // namespace

void query_light(const LightOptions& options) {
  if (!options.plot.empty()) require_extension(options.plot, {".svg"});
  require_distinct(options.plot.empty() ? std::vector<std::filesystem::path>{} : std::vector{options.plot},
                   files_among({options.name, options.filters, options.reflectance}));
  const Curve light = requested_light(options);
  const XYZ xyz = tristimulus(light, Curve(1), Observer::cie1931, options.range);
  if (!std::isfinite(xyz[0]))
    throw Error(ErrorCode::input, options.name, "has no visible light and therefore no colour");
  const auto temperature = color_temperature(xyz);
  const auto rendering = color_rendering(light, options.range);
  const auto fidelity = color_fidelity(light, options.range);
  Json answer;
  answer["xy"] = chromaticity(xyz);
  answer["uv_1960"] = uv_1960(xyz);
  answer["CCT_K"] = temperature ? Json(temperature->kelvin) : Json();
  answer["Duv"] = temperature ? Json(temperature->duv) : Json();
  answer["LER_lm_per_W"] = luminous_efficacy(light);
  answer["S_over_P"] = scotopic_photopic_ratio(light, options.range);
  answer["Ra"] = rendering ? Json(rendering->general) : Json();
  if (rendering) answer["R"] = rendering->special;
  if (fidelity)
    add_fidelity(answer, *fidelity, options.samples);
  else
    for (const char* key : {"Rf", "Rg"}) answer[key] = Json();
  if (options.samples && !fidelity) answer["Rs"] = Json();
  if (!options.plot.empty()) {
    if (!fidelity)
      throw Error(
          ErrorCode::input, options.name,
          "has no colour temperature up to 25 000 K, so that --plot has no reference to compare with");
    write_atomically(options.plot, color_vector_graphic(*fidelity, options.name));
  }
  print(answer, options.json);
}

void query_metamerism(const MetamerismOptions& options) {
  Diagnostics diagnostics;
  const Curve first = curve_for(kReflectanceUse, options.first, diagnostics);
  const Curve second = curve_for(kReflectanceUse, options.second, diagnostics);
  const auto reference = load_illuminant(options.reference, {}, diagnostics);
  const auto test = load_illuminant(options.test, {}, diagnostics);
  for (const auto& light : {reference, test})
    if (light) check_light_range(*light, observer_channels(Observer::cie1931), {}, diagnostics);
  check(diagnostics);
  const Metamerism result = metamerism(first, second, reference->curve, test->curve, options.range);
  Json answer;
  answer["reference_dE76"] = result.reference_76;
  answer["dE76"] = result.index_76;
  answer["dE00"] = result.index_2000;
  print(answer, options.json);
}

}  // namespace abbe::cli
