#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "calibration/chart/patches.h"
#include "calibration/fit/correction.h"
#include "sensor/readout/photon_transfer.h"
#include "sensor/readout/readout.h"
#include "sensor/response/channel.h"
#include "spectral/library.h"
#include "spectral/sources.h"
#include "validation/cases/suites.h"
#include "validation/cases/tables.h"

namespace abbe {
namespace {

Figures ccd_counts() {
  return figures_of_rows("ccd_bandpass_counts", [&](Figures& figures, const ReferenceRow& row) {
    const std::string& filter = row.text("passband");
    const std::string& efficiency = row.text("ccd_qe");
    const double kelvin = row.number("T_K");
    const Curve response = product(shipped_curve("filter", filter),
                                   efficiency == "none" ? Curve(1.0) : shipped_curve("camera", efficiency));
    const Channel channel = quantum_channel("counts", response);
    figures.push_back({fmt::format("{} {} K, efficiency {}", filter, kelvin, efficiency),
                       row.number("N"),
                       {sum_product(planck(kelvin), channel.weight, {300, 1050})}});
  });
}

// The counts of `ccd_counts` as those of a film. A fraction pi/(4 N^2) of the radiance arrives at the film of
// an f/4 lens; the exposure is 20 ms.
std::vector<Case> flat_fields() {
  const ReferenceTable table("ccd_bandpass_counts");
  std::vector<Case> cases;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& filter = table.text(row, "passband");
    const std::string& kelvin = table.text(row, "T_K");
    const std::string& efficiency = table.text(row, "ccd_qe");
    if (efficiency == "none") continue;
    const double expected = table.number(row, "N") * std::numbers::pi / (4 * 4 * 4) * 0.02;
    cases.push_back({Suite::sensor,
                     fmt::format("flat-{}-{}", filter, kelvin),
                     fmt::format("flat field of a CCD behind {}, black body of {} K", filter, kelvin),
                     "photon counts of Planck's law [Planck1901] through an f/4 lens",
                     "electrons/m²",
                     {0.01, Margin::Kind::relative},
                     FilmMean{"flat_field.json",
                              {{"/sensor/quantum_efficiency", efficiency},
                               {"/sensor/channels/electrons/filters/0", filter},
                               {"/lights/0/emission/blackbody_K", kelvin}},
                              "electrons",
                              expected,
                              64,
                              0.001}});
  }
  return cases;
}

// A dome of 0.146 W/(m^2 sr) at 555 nm through f/4 for 10 ms, with a quantum efficiency of 60 %; as in
// `exposure.json`.
Case worked_example() {
  constexpr double kPerPhoton = 0.6;
  const double energy = std::numbers::pi / (4 * 4 * 4) * 0.146 * 0.01;  // per m^2 of the film
  return {Suite::sensor,
          "worked-example",
          "worked example: 2433 electrons in a pixel of 4.5 µm, as electrons per m²",
          "πLtQλ/(4N²hc), the camera equation [Pharr2023, sec. 5.4]",
          "electrons/m²",
          {0.01, Margin::Kind::relative},
          FilmMean{"../exposure.json", {}, "mono", energy * kPerPhoton / photon_energy(555), 64, 5e-4}};
}

// Scaled by s, the band is 10 s wide and centred at 650 s. A shift of 0.05 nm changes the film by 4e-4.
Case tilted_filter() {
  constexpr double kIndex = 2;
  const double s = std::sqrt(1 - 0.36 / (kIndex * kIndex));
  const double wedge = (650 * s - 500) / (700 - 500);
  return {Suite::sensor,
          "tilted-filter",
          "interference filter of 10 nm, tilted by 36.87°: position of its band",
          "λ0 sqrt(1 - sin²θ/n²) [Smith2008, ch. 11]",
          "J/m²",
          {0.01, Margin::Kind::relative},
          FilmMean{"tilted_filter.json", {}, "wedge", 0.8 / 25 * 10 * s * wedge, 128, 4e-4}};
}

// Two simulated flat frames of one sensor.
struct SimulatedPair {
  double exposure_s;
  RawFrame first;
  RawFrame second;
};
SimulatedPair simulate(const Readout& readout, double electrons, double exposure_s, std::uint32_t frame) {
  constexpr std::size_t kPixels = 1000000;
  const std::vector<float> expected(kPixels, static_cast<float>(electrons));
  return {exposure_s, read_out(readout, expected, {exposure_s, 20, frame}),
          read_out(readout, expected, {exposure_s, 20, frame + 1})};
}

// Photon transfer of a simulated sensor with known parameters: a million pixels, dark and illuminated.
Figures transferred() {
  Readout sensor;
  sensor.gain_e_per_dn = 1.6;
  sensor.bits = 14;
  sensor.offset_dn = 200;
  sensor.full_well_e = 20000;
  sensor.read_noise_e = 9;
  sensor.dark_e_per_s = 60;
  sensor.prnu_percent = 1.5;
  sensor.dsnu_e = 12;
  std::vector<SimulatedPair> frames;
  for (const double seconds : {0.01, 20.0})
    frames.push_back(simulate(sensor, 0, seconds, static_cast<std::uint32_t>(2 * frames.size())));
  for (const double well_fraction : {0.35, 0.5, 0.65, 1.6})
    frames.push_back(simulate(sensor, well_fraction * sensor.full_well_e, 0.01,
                              100 + static_cast<std::uint32_t>(2 * frames.size())));
  std::vector<FlatPair> pairs;
  for (const SimulatedPair& pair : frames) pairs.push_back({pair.exposure_s, pair.first.dn, pair.second.dn});
  const PhotonTransfer transfer =
      photon_transfer(std::span(pairs).first(2), std::span(pairs).subspan(2), sensor.bits);
  return {{"gain e/DN", sensor.gain_e_per_dn, {transfer.gain_e_per_dn}},
          {"read noise e", sensor.read_noise_e, {transfer.read_noise_e}},
          {"dark current e/s", sensor.dark_e_per_s, {transfer.dark_e_per_s}},
          {"PRNU %", sensor.prnu_percent, {transfer.prnu_percent}},
          {"DSNU e", sensor.dsnu_e, {transfer.dsnu_e}},
          {"full well e", sensor.full_well_e, {transfer.full_well_e.value_or(0)}}};
}

// Row 0 of a chart is the perfect diffuser.
Curve patch_of(const std::string& spectra, std::size_t index) {
  return index == 0 ? Curve(1.0) : shipped_chart(spectra).patches.at(index - 1).reflectance;
}

Figures raw_values() {
  return figures_of_rows("camera_raw_colorchecker", [&](Figures& figures, const ReferenceRow& row) {
    const std::string& name = row.text("camera");
    const std::string& light = row.text("illuminant");
    const std::vector<Channel> channels = shipped_camera(name);
    const std::vector<double> raw =
        camera_raw(channels, shipped_illuminant(light),
                   patch_of(row.text("spectra"), static_cast<std::size_t>(row.number("index"))));
    for (std::size_t k = 0; k < raw.size(); ++k)
      figures.push_back({fmt::format("{} {} {} {}", name, light, row.text("patch"), channels[k].name),
                         row.number("raw_" + channels[k].name),
                         {raw[k]}});
  });
}

struct Fitted {
  std::string name;
  PatchColors colors;
  Matrix3 matrix;
};
Fitted fit_row(const ReferenceRow& row) {
  const std::string& camera = row.text("camera");
  const std::string& spectra = row.text("spectra");
  const std::string& light = row.text("illuminant");
  PatchColors colors =
      integrate(shipped_chart(spectra), shipped_camera(camera), shipped_illuminant(light), kVisibleRange);
  const Matrix3 matrix = least_squares_matrix(colors);
  return {fmt::format("{} {} {}", camera, light, spectra), std::move(colors), matrix};
}

Figures least_squares_matrices() {
  return figures_of_rows("camera_least_squares_matrix", [&](Figures& figures, const ReferenceRow& row) {
    const Fitted fitted = fit_row(row);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const std::string entry = fmt::format("m{}{}", i + 1, j + 1);
        figures.push_back({fitted.name + " " + entry, row.number(entry), {fitted.matrix[i][j]}});
      }
  });
}

Figures least_squares_differences() {
  return figures_of_rows("camera_least_squares_matrix", [&](Figures& figures, const ReferenceRow& row) {
    const Fitted fitted = fit_row(row);
    const PatchErrors errors = patch_errors(fitted.colors, linear_correction(fitted.matrix));
    figures.push_back({fitted.name + " mean", row.number("dE00_mean"), {errors.mean}});
    figures.push_back({fitted.name + " max", row.number("dE00_max"), {errors.max}});
  });
}

}  // namespace

std::vector<Case> sensor_cases() {
  const ComputedCases computed{Suite::sensor};
  std::vector<Case> cases{
      computed("ccd-counts", "electrons of a filtered CCD in front of black bodies",
               "photon counts of Planck's law [Planck1901] in measured passbands [Bessell1990]",
               "1/(s m² sr)", {1e-6, Margin::Kind::relative}, ccd_counts),
      worked_example(), tilted_filter(),
      computed("photon-transfer", "photon transfer recovers the parameters of a simulated sensor",
               "the method of [EMVA1288] on simulated flats", "", {0.005, Margin::Kind::relative},
               transferred)};
  for (Case& item : flat_fields()) cases.push_back(std::move(item));
  return cases;
}

std::vector<Case> camera_cases() {
  const ComputedCases computed{Suite::camera};
  const std::string source = "linear least squares over measured spectra [Pascale2012], [Ohta1997]";
  return {
      computed("raw", "raw values of a measured camera for the ColorChecker",
               "sums over measured sensitivities and spectra [Pascale2012], [Ohta1997]", "", {5.1e-8},
               raw_values),
      computed("least-squares", "least-squares matrices of a measured camera", source, "", {1e-6},
               least_squares_matrices),
      computed("least-squares-dE", "residual colour differences of those matrices", source, "ΔE", {5.1e-5},
               least_squares_differences),
  };
}

}  // namespace abbe
