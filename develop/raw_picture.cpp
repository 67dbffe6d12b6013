#include "develop/raw_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "calibration/output/camera_profile.h"
#include "io/error.h"
#include "io/json.h"
#include "io/json_values.h"
#include "io/table.h"
#include "io/text.h"
#include "sensor/readout/speed.h"

namespace abbe {
namespace {

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

constexpr int kLastOfExif = 24;

const JsonValue* member(const JsonValue& value, const char* key, Diagnostics& diagnostics) {
  const JsonValue* const found = value.find(key);
  if (found == nullptr) diagnostics.error(value.where, fmt::format("missing key \"{}\"", key));
  return found;
}

std::array<double, 9> read_matrix(const JsonValue& light, const char* key, Diagnostics& diagnostics) {
  std::array<double, 9> matrix{};
  const JsonValue* const value = member(light, key, diagnostics);
  const JsonValue::Array* const rows =
      value != nullptr ? read_array(*value, "rows", 3, diagnostics) : nullptr;
  if (rows == nullptr) return matrix;
  if (rows->size() != 3)
    diagnostics.error(value->where, fmt::format("expected 3 rows (got {})", rows->size()));
  for (std::size_t i = 0; i < 3; ++i)
    if (const auto row = read_numbers((*rows)[i], 3, Range::any(), diagnostics))
      std::copy(row->begin(), row->end(), matrix.begin() + static_cast<std::ptrdiff_t>(3 * i));
  return matrix;
}

RawLight read_light(const JsonValue& light, Diagnostics& diagnostics) {
  RawLight read{0};
  if (const JsonValue* const code = member(light, "CalibrationIlluminant", diagnostics))
    if (const auto number = read_number(*code, {0, 255}, diagnostics)) {
      read.illuminant = static_cast<int>(*number);
      if (read.illuminant < 1 || read.illuminant > kLastOfExif)
        diagnostics.error(code->where,
                          fmt::format("the illuminant has no Exif code, so raw converters cannot identify it "
                                      "(got {}, allowed A, B, C, D50, D55, D65, D75 and fluorescent lights)",
                                      read.illuminant));
    }
  read.color = read_matrix(light, "ColorMatrix", diagnostics);
  read.forward = read_matrix(light, "ForwardMatrix", diagnostics);
  return read;
}

DngProfile read_profile(const std::shared_ptr<const SourceText>& source, Diagnostics& diagnostics) {
  DngProfile profile;
  const std::optional<JsonValue> root = parse_json(source, diagnostics);
  if (const JsonValue* const camera = root ? root->find("camera") : nullptr)
    profile.camera = read_string(*camera, diagnostics).value_or("");
  const JsonValue* const list = root ? member(*root, "lights", diagnostics) : nullptr;
  const JsonValue::Array* const all = list != nullptr ? read_array(*list, "lights", 2, diagnostics) : nullptr;
  if (all == nullptr) return profile;
  if (all->size() != 2)
    diagnostics.error(list->where, fmt::format("expected 2 lights (got {})", all->size()));
  for (const JsonValue& light : *all) profile.lights.push_back(read_light(light, diagnostics));
  return profile;
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

std::optional<DngProfile> read_dng_profile(const std::filesystem::path& path, Diagnostics& diagnostics) {
  const auto source = read_text(path, diagnostics);
  if (!source) return std::nullopt;
  Diagnostics faults;  // reported as errors of an input, not of a scene
  DngProfile profile = read_profile(source, faults);
  for (const Diagnostic& fault : faults.all())
    diagnostics.error(fault.where, fault.message, ErrorCode::input);
  if (faults.has_errors()) return std::nullopt;
  return profile;
}

void require_same_camera(const DngProfile& profile, const FilmSensor& sensor,
                         const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& allowed) {
    throw Error(ErrorCode::input, path.string(),
                fmt::format("has the matrices of another camera than the film's (got {}, allowed {})",
                            profile.camera, allowed));
  };
  if (profile.camera.empty()) return;
  if (!sensor.measured_camera.empty()) {
    const std::filesystem::path measured(sensor.measured_camera);
    if (std::filesystem::path(profile.camera).filename() != measured.filename()) refuse(measured.string());
    return;
  }
  const std::vector<std::string> shipped = table_names("camera");
  if (std::ranges::find(shipped, profile.camera) != shipped.end() &&
      sensor.description.find(profile.camera) == std::string::npos)
    refuse("those of its own channels");
}

}  // namespace abbe
