#include "develop/raw_picture.h"

#include <cmath>

#include "calibration/output/camera_profile.h"
#include "sensor/readout/speed.h"

namespace abbe {
namespace {

// Codes pixel by pixel, with the planes of a pixel together.
std::vector<std::uint16_t> interleaved(const Image& codes, const std::vector<std::string>& planes) {
  std::vector<const ImageChannel*> found;
  for (const std::string& plane : planes) found.push_back(codes.find(plane));
  std::vector<std::uint16_t> values;
  values.reserve(codes.pixels() * planes.size());
  for (std::size_t i = 0; i < codes.pixels(); ++i)
    for (const ImageChannel* plane : found) values.push_back(static_cast<std::uint16_t>(plane->values[i]));
  return values;
}

std::array<double, 9> rows_of(const Matrix3& matrix) {
  std::array<double, 9> rows{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rows[static_cast<std::size_t>(3 * i + j)] = matrix[i][j];
  return rows;
}

// Records the colour matrices of raw values, which are film values times each channel's exposure. They come
// from the display matrix without its adaptation of the film's white to D65. If chromatic adaptation of the
// white is impossible, D65 takes its place.
void record_colors(const FilmSensor& sensor, RawPicture& raw) {
  raw.lights = sensor.lights;
  if (!sensor.display || sensor.channels.size() != 3) return;
  const bool adapts = sensor.white && adaptation(unit_xyz(*sensor.white), unit_xyz(kD65));
  const Chromaticity white = adapts ? *sensor.white : kD65;
  const auto matrices =
      dng_matrices(white_adaptation(white).inverse(true) * sensor.display->to_xyz_d65(), unit_xyz(white));
  if (!matrices) return;
  if (raw.lights.empty())
    raw.lights = {{exif_light_source(white), rows_of(matrices->color), rows_of(matrices->forward)}};
  raw.neutral = matrices->neutral;
}

}  // namespace

RawPicture raw_picture(const DevelopedFilm& developed, const FilmSensor& sensor) {
  const Readout& readout = *sensor.readout;
  RawPicture raw;
  raw.width = developed.codes.width;
  raw.height = developed.codes.height;
  raw.planes = sensor.planes;
  raw.codes = interleaved(developed.codes, sensor.planes);
  raw.channels = sensor.channels;
  if (sensor.mosaic) {
    raw.mosaic_width = sensor.mosaic->width;
    raw.mosaic.assign(sensor.mosaic->channel.begin(), sensor.mosaic->channel.end());
  }
  raw.black_level_dn = black_level(sensor);
  raw.linear_codes = linear_codes(readout);
  raw.white_level_dn = white_level(readout);
  raw.gain_e_per_dn = readout.gain_e_per_dn;
  raw.read_noise_e = readout.read_noise_e;
  if (std::isfinite(readout.full_well_e)) raw.full_well_e = readout.full_well_e;
  raw.exposure_s = common_exposure(sensor);
  raw.f_number = sensor.f_number;
  if (sensor.electrons_per_lx_s) raw.iso_speed = saturation_speed(readout, *sensor.electrons_per_lx_s);
  record_colors(sensor, raw);
  raw.camera = sensor.camera;
  raw.metadata = developed.codes.metadata;
  return raw;
}

}  // namespace abbe
