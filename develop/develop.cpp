#include "develop/develop.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "calibration/output/display.h"
#include "develop/radiance.h"
#include "io/text.h"
#include "sensor/film/crop.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/readout/demosaic.h"
#include "sensor/readout/speed.h"

namespace abbe {
namespace {

// Records how pictures show the film. The white is the film's own unless another was requested.
void record_display(const FilmSensor& sensor, std::map<std::string, std::string>& metadata) {
  if (sensor.display_exposure) metadata[kDisplayExposureKey] = fmt::format("{}", *sensor.display_exposure);
  if (sensor.white_name.empty() || !sensor.white || !sensor.display) return;
  const bool requested = metadata.contains(kWhiteRequestedKey) && metadata[kWhiteKey] == sensor.white_name;
  record_white(sensor.white_name, *sensor.white, requested, metadata);
  metadata["to_xyz_d65"] = to_text(sensor.display->to_xyz_d65());
}

// Records the fraction of saturation of a flat frame for its current exposure and readout.
void record_frame(const ExposedFilm& exposed, std::map<std::string, std::string>& metadata) {
  const FilmSensor& sensor = exposed.sensor;
  const auto frame = metadata.find(kFrameKey);
  if (frame == metadata.end() || !frame->second.starts_with(kFlatFrame) || !sensor.readout) return;
  const auto light = static_cast<double>(exposed.film.find(sensor.planes.front())->values.front());
  frame->second = fmt::format("{}, {:.6g} of saturation", kFlatFrame,
                              light * sensor.gathering_area_m2 / saturation_electrons(*sensor.readout));
}

std::map<std::string, std::string> metadata_of(const ExposedFilm& exposed) {
  const FilmSensor& sensor = exposed.sensor;
  std::map<std::string, std::string> metadata = exposed.film.metadata;
  erase_layer_and_feature_attributes(metadata);
  record_display(sensor, metadata);
  record_frame(exposed, metadata);
  if (!sensor.description.empty()) metadata["sensor"] = sensor.description;
  if (sensor.readout && sensor.electrons_per_lx_s)
    metadata[kIsoSpeedKey] =
        fmt::format("{}", static_cast<float>(saturation_speed(*sensor.readout, *sensor.electrons_per_lx_s)));
  return metadata;
}

Image like(const ExposedFilm& exposed) {
  return {exposed.film.width, exposed.film.height, {}, metadata_of(exposed)};
}

// Exposure [1/m^2] that gives `electrons` in total, including the dark signal.
double exposure_of(const FilmSensor& sensor, double electrons, double seconds) {
  return (electrons - sensor.readout->dark_e_per_s * seconds) / sensor.gathering_area_m2;
}

// Exposure time [s] of each pixel under a mosaic whose channels differ in it; empty otherwise.
std::vector<double> pixel_exposures(const FilmSensor& sensor, const Image& film) {
  std::vector<double> seconds;
  if (!sensor.mosaic || common_exposure(sensor)) return seconds;
  seconds.reserve(film.pixels());
  for (int y = 0; y < film.height; ++y)
    for (int x = 0; x < film.width; ++x)
      seconds.push_back(sensor.exposure_s[static_cast<std::size_t>(sensor.mosaic->at(x, y))]);
  return seconds;
}

void read_plane(const ExposedFilm& exposed, std::size_t plane, std::uint64_t seed, std::uint32_t frame,
                DevelopedFilm& developed) {
  const FilmSensor& sensor = exposed.sensor;
  const Readout& readout = *sensor.readout;
  const std::string& name = sensor.planes[plane];
  ImageChannel electrons{name, {}};
  for (const float value : exposed.film.find(name)->values)
    electrons.values.push_back(static_cast<float>(value * sensor.gathering_area_m2));
  const std::vector<double> own_seconds = pixel_exposures(sensor, exposed.film);
  const auto planes = static_cast<std::uint32_t>(sensor.planes.size());
  const Exposure exposure{sensor.exposure_s[plane], seed, frame * planes + static_cast<std::uint32_t>(plane),
                          static_cast<std::size_t>(exposed.film.width), own_seconds};
  const RawFrame raw = read_out(readout, electrons.values, exposure);
  ImageChannel calibrated{name, {}};
  for (std::size_t i = 0; i < raw.dn.size(); ++i)
    calibrated.values.push_back(
        static_cast<float>(exposure_of(sensor, electrons_of(readout, raw.dn[i]), exposure.seconds_of(i))));
  developed.electrons.channels.push_back(std::move(electrons));
  developed.codes.channels.push_back({name, {raw.dn.begin(), raw.dn.end()}});
  developed.codes.channels.push_back({"Saturated." + name, {raw.saturated.begin(), raw.saturated.end()}});
  developed.calibrated.channels.push_back(std::move(calibrated));
}

// Records the unit of the sensor's channels in place of the film's.
void record_unit(const char* unit, std::map<std::string, std::string>& metadata) {
  for (auto& [key, text] : metadata)
    if (key.starts_with("channel.")) text = unit;
}

void record_codes(const FilmSensor& sensor, std::map<std::string, std::string>& metadata) {
  const Readout& readout = *sensor.readout;
  metadata["codes"] =
      fmt::format("digital numbers 0 to {}, {}", readout.highest_code(),
                  readout.response_curve ? "by a response curve" : "linear, not scaled to 16 bits");
  metadata[kBlackLevelKey] = fmt::format("{}", black_level(sensor));
  metadata[kWhiteLevelKey] = fmt::format("{}", white_level(readout));
  metadata["gain_e_per_dn"] = fmt::format("{}", readout.gain_e_per_dn);
}

// Film values at which the channels of a picture saturate; empty for a sensor without a readout or without
// colours.
std::optional<std::vector<double>> picture_saturation(const FilmSensor& sensor) {
  if (!sensor.readout || !sensor.display || sensor.channels.size() != 3) return std::nullopt;
  const double full_e = electrons_of(*sensor.readout, white_level(*sensor.readout));
  std::vector<double> saturation;
  for (const double seconds : sensor.exposure_s) saturation.push_back(exposure_of(sensor, full_e, seconds));
  if (!sensor.flattens_field || !sensor.white_field) return saturation;
  const std::vector<double> responses = largest_response(*sensor.white_field);
  for (std::size_t k = 0; k < saturation.size(); ++k) saturation[k] /= responses[k];
  return saturation;
}

bool has_pixel_at(const Image& planes, const std::vector<std::string>& channels,
                  const std::array<double, 3>& values) {
  std::array<const ImageChannel*, 3> found{};
  for (std::size_t k = 0; k < found.size(); ++k) found[k] = planes.find(channels[k]);
  const std::vector<std::size_t> pixels = recorded_pixels(planes);
  return std::any_of(pixels.begin(), pixels.end(), [&](std::size_t pixel) {
    for (std::size_t k = 0; k < found.size(); ++k)
      if (found[k]->values[pixel] < static_cast<float>(values[k])) return false;
    return true;
  });
}

template <typename Value>
double mean(const std::vector<std::size_t>& pixels, const std::vector<Value>& values) {
  double sum = 0;
  for (const std::size_t pixel : pixels) sum += static_cast<double>(values[pixel]);
  return sum / static_cast<double>(pixels.size());
}

}  // namespace

DevelopedFilm develop(const ExposedFilm& exposed, std::uint64_t seed, std::uint32_t frame) {
  const Image& film = exposed.film;
  const Image empty = like(exposed);
  DevelopedFilm developed{empty, empty, empty, empty, empty};
  for (std::size_t plane = 0; plane < exposed.sensor.planes.size(); ++plane) {
    const std::string& name = exposed.sensor.planes[plane];
    developed.exposure.channels.push_back(*film.find(name));
    if (const ImageChannel* variance = film.find(variance_of(name)))
      developed.variance.channels.push_back(*variance);
    if (exposed.sensor.readout) read_plane(exposed, plane, seed, frame, developed);
  }
  record_unit("electrons per pixel", developed.electrons.metadata);
  record_unit("digital numbers", developed.codes.metadata);
  if (exposed.sensor.readout) record_codes(exposed.sensor, developed.codes.metadata);
  if (!exposed.sensor.readout) developed.calibrated = developed.exposure;
  return developed;
}

double black_level(const FilmSensor& sensor) {
  const std::optional<double> exposure_s = common_exposure(sensor);
  return exposure_s ? black_level(*sensor.readout, *exposure_s) : sensor.readout->offset_dn;
}

std::optional<std::string> unequal_dark_signals_warning(const FilmSensor& sensor) {
  const double dark_dn_per_s = sensor.readout->dark_e_per_s / sensor.readout->gain_e_per_dn;
  if (dark_dn_per_s == 0 || sensor.exposure_s.empty() || common_exposure(sensor)) return std::nullopt;
  const auto [min_s, max_s] = std::minmax_element(sensor.exposure_s.begin(), sensor.exposure_s.end());
  return fmt::format(
      "channels with different exposure times have different dark signals ({:.3g} to {:.3g} DN): the "
      "black level of raw files does not include them",
      dark_dn_per_s * *min_s, dark_dn_per_s * *max_s);
}

std::uint64_t render_seed(const Image& film) {
  return static_cast<std::uint64_t>(number_of(film.metadata, "seed").value_or(0));
}

Image display_planes(const FilmSensor& sensor, const Image& calibrated) {
  Image planes = sensor.mosaic ? demosaic(calibrated, sensor.planes.front(), *sensor.mosaic, sensor.channels)
                               : calibrated;
  erase_layer_and_feature_attributes(planes.metadata);
  if (sensor.flattens_field && sensor.white_field) flatten(planes, sensor.channels, *sensor.white_field);
  if (const auto saturation = picture_saturation(sensor))
    clip_to_white(planes, sensor.channels, sensor.display->to_xyz_d65(), *saturation);
  return planes;
}

double display_white(const FilmSensor& sensor, const Image& planes) {
  require_display(sensor);
  if (sensor.display_exposure) return *sensor.display_exposure;
  const double automatic = 1 / sensor.display->automatic_scale(planes);
  const auto saturation = picture_saturation(sensor);
  const Matrix3& to_xyz = sensor.display->to_xyz_d65();
  const auto white = saturation ? brightest_neutral(to_xyz, *saturation) : std::nullopt;
  if (!white || !has_pixel_at(planes, sensor.channels, *white)) return automatic;
  return std::min(automatic, multiply(to_xyz, *white)[1]);
}

std::vector<PlaneFigures> plane_figures(const FilmSensor& sensor, const DevelopedFilm& developed) {
  const double unit = sensor.readout ? sensor.gathering_area_m2 : 1;
  const Image& counted = sensor.readout ? developed.electrons : developed.exposure;
  const std::vector<std::size_t> rendered = recorded_pixels(developed.exposure);
  const auto over_film = [&](const auto& values) { return mean(rendered, values); };
  const std::vector<double> own_seconds = pixel_exposures(sensor, developed.exposure);
  const bool is_known = !has_unknown_error(developed.exposure.metadata);
  std::vector<PlaneFigures> all;
  for (std::size_t plane = 0; plane < sensor.planes.size(); ++plane) {
    PlaneFigures& figures = all.emplace_back();
    figures.mean = over_film(counted.channels[plane].values);
    const ImageChannel* variance = developed.variance.find(variance_of(sensor.planes[plane]));
    const double mean_variance = variance != nullptr ? over_film(variance->values) : 0;
    if (variance != nullptr && is_known && std::isfinite(mean_variance))
      figures.render_error = std::sqrt(mean_variance) * unit;
    if (!sensor.readout) continue;
    const double seconds = own_seconds.empty() ? sensor.exposure_s[plane] : over_film(own_seconds);
    figures.noise = temporal_noise(*sensor.readout, figures.mean, seconds);
    figures.saturated_fraction = over_film(developed.codes.find("Saturated." + sensor.planes[plane])->values);
  }
  return all;
}

}  // namespace abbe
