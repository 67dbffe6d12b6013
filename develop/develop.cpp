#include "develop/develop.h"

#include <algorithm>
#include <cmath>

#include "calibration/output/white_clip.h"
#include "io/text.h"
#include "sensor/film/variance_name.h"
#include "sensor/readout/demosaic.h"

namespace abbe {
namespace {

Image like(const Image& film) {
  return {film.width, film.height, {}, film.metadata};
}

// Exposure [per m^2] that gives so many electrons, those of the dark included.
double exposure_of(const FilmSensor& sensor, double electrons, double seconds) {
  return (electrons - sensor.readout->dark_e_per_s * seconds) / sensor.gathering_area_m2;
}

void read_plane(const ExposedFilm& exposed, std::size_t plane, std::uint64_t seed, DevelopedFilm& developed) {
  const FilmSensor& sensor = exposed.sensor;
  const Readout& readout = *sensor.readout;
  const std::string& name = sensor.planes[plane];
  ImageChannel electrons{name, {}};
  for (const float value : exposed.film.find(name)->values)
    electrons.values.push_back(static_cast<float>(value * sensor.gathering_area_m2));
  const double seconds = sensor.exposure_s[plane];
  const RawFrame raw =
      read_out(readout, electrons.values, {seconds, seed, static_cast<std::uint32_t>(plane)});
  ImageChannel calibrated{name, {}};
  for (const std::uint16_t dn : raw.dn)
    calibrated.values.push_back(static_cast<float>(exposure_of(sensor, electrons_of(readout, dn), seconds)));
  developed.electrons.channels.push_back(std::move(electrons));
  developed.codes.channels.push_back({name, {raw.dn.begin(), raw.dn.end()}});
  developed.codes.channels.push_back({"Saturated." + name, {raw.saturated.begin(), raw.saturated.end()}});
  developed.calibrated.channels.push_back(std::move(calibrated));
}

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

}  // namespace

DevelopedFilm develop(const ExposedFilm& exposed, std::uint64_t seed) {
  const Image& film = exposed.film;
  DevelopedFilm developed{like(film), like(film), like(film), like(film), like(film)};
  for (std::size_t plane = 0; plane < exposed.sensor.planes.size(); ++plane) {
    const std::string& name = exposed.sensor.planes[plane];
    developed.exposure.channels.push_back(*film.find(name));
    if (const ImageChannel* variance = film.find(variance_of(name)))
      developed.variance.channels.push_back(*variance);
    if (exposed.sensor.readout) read_plane(exposed, plane, seed, developed);
  }
  if (!exposed.sensor.readout) developed.calibrated = developed.exposure;
  return developed;
}

std::uint64_t render_seed(const Image& film) {
  const auto seed = film.metadata.find("seed");
  return seed == film.metadata.end() ? 0 : static_cast<std::uint64_t>(parse_number(seed->second).value_or(0));
}

Image display_planes(const FilmSensor& sensor, const Image& calibrated) {
  Image planes = sensor.mosaic ? demosaic(calibrated, sensor.planes.front(), *sensor.mosaic, sensor.channels)
                               : calibrated;
  if (!sensor.readout || !sensor.display || sensor.channels.size() != 3) return planes;
  const Readout& readout = *sensor.readout;
  const double full_e = std::min(readout.full_well_e, electrons_of(readout, readout.highest_code()));
  std::vector<double> saturation;
  for (std::size_t k = 0; k < 3; ++k)
    saturation.push_back(
        exposure_of(sensor, full_e, sensor.exposure_s[std::min(k, sensor.planes.size() - 1)]));
  clip_to_white(planes, sensor.channels, sensor.display->to_xyz_d65(), saturation);
  return planes;
}

std::vector<PlaneFigures> plane_figures(const FilmSensor& sensor, const DevelopedFilm& developed) {
  const double unit = sensor.readout ? sensor.gathering_area_m2 : 1;
  const Image& counted = sensor.readout ? developed.electrons : developed.exposure;
  std::vector<PlaneFigures> all;
  for (std::size_t plane = 0; plane < sensor.planes.size(); ++plane) {
    PlaneFigures& figures = all.emplace_back();
    figures.mean = mean(counted.channels[plane].values);
    if (const ImageChannel* variance = developed.variance.find(variance_of(sensor.planes[plane])))
      figures.render_error = std::sqrt(mean(variance->values)) * unit;
    if (!sensor.readout) continue;
    figures.noise = temporal_noise(*sensor.readout, figures.mean, sensor.exposure_s[plane]);
    figures.saturated_share = mean(developed.codes.find("Saturated." + sensor.planes[plane])->values);
  }
  return all;
}

}  // namespace abbe
