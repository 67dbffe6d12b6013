// Exposure times of films, and calibration frames.
#include <algorithm>
#include <array>
#include <memory>

#include <fmt/format.h>

#include "develop/film_sensor.h"
#include "io/error.h"
#include "io/json.h"
#include "io/text.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/readout/speed.h"

namespace abbe {
namespace {

void scale_plane(Image& film, const std::string& name, double factor) {
  for (ImageChannel& channel : film.channels)
    if (channel.name == name)
      for (float& value : channel.values) value = static_cast<float>(static_cast<double>(value) * factor);
}

// The film's sensor description. It was parsed before, so errors are ignored.
std::optional<JsonValue> spec_of(const FilmSensor& sensor) {
  Diagnostics none;
  return parse_json(std::make_shared<const SourceText>(SourceText{"", sensor.description}), none);
}

// The number under a key of an object; nullptr if there is none.
double* number_in(JsonValue* spec, const char* key) {
  JsonValue* member = spec != nullptr ? spec->find(key) : nullptr;
  return member != nullptr ? std::get_if<double>(&member->value) : nullptr;
}

// Updates the exposure times in the description: of the sensor, of channels, and of the shutter, whose times
// scale.
void describe_exposure(FilmSensor& sensor, double factor) {
  std::optional<JsonValue> spec = spec_of(sensor);
  if (!spec) return;
  Diagnostics none;
  set_json(*spec, "/exposure_s", fmt::format("{}", sensor.shared_exposure_s), none);
  if (JsonValue* channels = spec->find("channels"); channels != nullptr)
    for (std::size_t k = 0; k < sensor.channels.size(); ++k)
      if (double* seconds = number_in(channels->find(sensor.channels[k]), "exposure_s"))
        *seconds = sensor.exposure_s[k];
  for (const char* key : {"rise_s", "fall_s", "row_delay_s"})
    if (double* seconds = number_in(spec->find("shutter"), key)) *seconds *= factor;
  sensor.description = to_text(*spec);
}

// Records the exposure time in full, and as the standard attribute in single precision.
void record_exposure(ExposedFilm& exposed, double factor) {
  std::map<std::string, std::string>& metadata = exposed.film.metadata;
  const FilmSensor& sensor = exposed.sensor;
  const auto scale = [&](const std::string& key, double value) {
    if (metadata.contains(key)) metadata[key] = fmt::format("{}", value);
  };
  scale("exposure_s", sensor.shared_exposure_s);
  for (std::size_t k = 0; k < sensor.channels.size(); ++k)
    scale("exposure_s." + sensor.channels[k], sensor.exposure_s[k]);
  if (const auto seconds = metadata.find("expTime"); seconds != metadata.end())
    if (const auto before = parse_number(seconds->second))
      seconds->second = fmt::format("{}", static_cast<float>(*before * factor));
}

// Multiplies all exposure times, also in description and metadata.
void set_exposure(ExposedFilm& exposed, double factor) {
  exposed.sensor.shared_exposure_s *= factor;
  for (double& seconds : exposed.sensor.exposure_s) seconds *= factor;
  describe_exposure(exposed.sensor, factor);
  record_exposure(exposed, factor);
}

void fill_plane(Image& film, const std::string& name, double value) {
  for (ImageChannel& channel : film.channels)
    if (channel.name == name)
      std::fill(channel.values.begin(), channel.values.end(), static_cast<float>(value));
}

bool is_zero(const JsonValue& spec) {
  const auto* number = std::get_if<double>(&spec.value);
  return number != nullptr && *number == 0;
}

// True if the transmission of the film's shutter varies during the exposure or between rows.
bool has_shaped_shutter(const FilmSensor& sensor) {
  const std::optional<JsonValue> spec = spec_of(sensor);
  const JsonValue* shutter = spec ? spec->find("shutter") : nullptr;
  constexpr std::array kShapes{"rise_s", "fall_s", "transmission", "row_delay_s"};
  return shutter != nullptr && std::any_of(kShapes.begin(), kShapes.end(), [&](const char* key) {
           const JsonValue* shape = shutter->find(key);
           return shape != nullptr && !is_zero(*shape);
         });
}

// The exposure time [s] that the film records.
double stated_exposure(const FilmSensor& sensor) {
  return common_exposure(sensor).value_or(sensor.shared_exposure_s);
}

void warn_of_shutter(const FilmSensor& sensor, Diagnostics& diagnostics) {
  if (!has_shaped_shutter(sensor)) return;
  const auto option = std::make_shared<const SourceText>(SourceText{"--exposure-s", ""});
  diagnostics.warning(
      {option, SourcePosition::kWholeFile, ""},
      fmt::format("motion blur remains that of the film's own exposure time of {} s; the opening, "
                  "closing and row delay of the shutter are scaled with the exposure time",
                  stated_exposure(sensor)));
}

}  // namespace

void expose_for(ExposedFilm& exposed, double seconds, Diagnostics& diagnostics) {
  const FilmSensor& sensor = exposed.sensor;
  if (sensor.exposure_s.empty())
    throw Error(ErrorCode::usage, "--exposure-s", "the film records no exposure time: radiances have none");
  if (stated_exposure(sensor) == 0)
    throw Error(ErrorCode::usage, "--exposure-s",
                "a bias frame is exposed for no time: use the film from which it was made");
  const double factor = seconds / stated_exposure(sensor);
  if (factor != 1) warn_of_shutter(sensor, diagnostics);
  for (const std::string& plane : sensor.planes) {
    scale_plane(exposed.film, plane, factor);
    scale_plane(exposed.film, variance_of(plane), factor * factor);
  }
  set_exposure(exposed, factor);
}

void replace_with_frame(ExposedFilm& exposed, const CalibrationFrame& frame) {
  const FilmSensor& sensor = exposed.sensor;
  if (!sensor.readout)
    throw Error(ErrorCode::usage, "--frame",
                "the film has no readout, which frames need: add one with --set '/readout={...}'");
  const auto* flat = std::get_if<FlatFrame>(&frame);
  const double light =
      flat ? flat->saturation_fraction * saturation_electrons(*sensor.readout) / sensor.gathering_area_m2 : 0;
  for (const std::string& plane : sensor.planes) {
    fill_plane(exposed.film, plane, light);
    fill_plane(exposed.film, variance_of(plane), 0);
  }
  exposed.film.metadata[kFrameKey] = flat                                       ? kFlatFrame
                                     : std::holds_alternative<DarkFrame>(frame) ? "dark"
                                                                                : kBiasFrame;
  for (const char* key : {kFrameMeanErrorKey, kHalfNoiseSamplesKey}) exposed.film.metadata.erase(key);
  if (std::holds_alternative<BiasFrame>(frame)) set_exposure(exposed, 0);
}

}  // namespace abbe
