#include "develop/film_sensor.h"

#include <algorithm>
#include <array>
#include <memory>

#include <fmt/format.h>

#include "io/error.h"
#include "io/text.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/readout/readout_json.h"
#include "sensor/readout/speed.h"
#include "sensor/response/polarised_channels.h"

namespace abbe {
namespace {

constexpr const char* kGainPointer = "/readout/gain_e_per_dn";

struct Metadata {
  const Image& film;
  const std::filesystem::path& path;

  [[nodiscard]] std::optional<std::string> find(const std::string& key) const {
    return attribute_of(film.metadata, key);
  }
  [[nodiscard]] std::string text(const std::string& key) const {
    if (auto found = find(key)) return *std::move(found);
    throw Error(
        ErrorCode::input, path.string(),
        fmt::format("no attribute \"{}\": not a rendered film, or one from an older version of Abbe", key));
  }
  [[nodiscard]] std::optional<double> find_number(const std::string& key, bool may_be_0 = false) const {
    const auto found = find(key);
    if (!found) return std::nullopt;
    const auto number = parse_number(*found);
    if (!number || *number < 0 || (*number == 0 && !may_be_0)) refuse(key);
    return number;
  }
  [[nodiscard]] double number(const std::string& key, bool may_be_0 = false) const {
    (void)text(key);
    return *find_number(key, may_be_0);
  }
  [[noreturn]] void refuse(const std::string& key) const {
    throw Error(ErrorCode::input, path.string(),
                fmt::format("attribute \"{}\" makes no sense (got \"{}\")", key, text(key)));
  }
};

void read_planes(const Metadata& data, FilmSensor& sensor) {
  sensor.planes = split(data.text("sensor_channels"), ',');
  sensor.channels = intensities(sensor.planes);
  const bool is_bias = data.find(kFrameKey) == kBiasFrame;
  const double exposure_s = sensor.shared_exposure_s = data.number("exposure_s", is_bias);
  if (data.find("mosaic")) {
    sensor.channels = split(data.text("mosaic_channels"), ',');
    sensor.mosaic = parse_mosaic(data.text("mosaic"), sensor.channels);
    if (!sensor.mosaic || sensor.planes.size() != 1) data.refuse("mosaic");
  }
  for (const std::string& channel : sensor.channels)
    sensor.exposure_s.push_back(data.find_number("exposure_s." + channel, is_bias).value_or(exposure_s));
}

// A gain replaces a speed, and a speed replaces a gain.
void replace_conversion(JsonValue& sensor, const std::string& pointer) {
  const std::string_view old = pointer == kIsoPointer    ? "gain_e_per_dn"
                               : pointer == kGainPointer ? "iso"
                                                         : "";
  JsonValue* readout = old.empty() ? nullptr : sensor.find("readout");
  if (readout != nullptr)
    if (auto* members = std::get_if<JsonValue::Object>(&readout->value))
      std::erase_if(*members, [old](const JsonValue::Member& member) { return member.first == old; });
}

std::string text_in(const JsonValue& object, const char* key) {
  const JsonValue* member = object.find(key);
  const auto* text = member != nullptr ? std::get_if<std::string>(&member->value) : nullptr;
  return text != nullptr ? *text : "";
}

void require_one_conversion(std::span<const Override> overrides) {
  const auto sets = [&](std::string_view pointer) {
    return std::ranges::find(overrides, pointer, &Override::pointer) != overrides.end();
  };
  if (sets(kIsoPointer) && sets(kGainPointer))
    throw Error(ErrorCode::usage, kIsoPointer,
                fmt::format("sets the gain, which {} sets too: use only one of them", kGainPointer));
}

std::optional<Readout> read_readout_of(const Metadata& data, FilmSensor& sensor,
                                       std::span<const Override> overrides, Diagnostics& diagnostics) {
  const auto source =
      std::make_shared<const SourceText>(SourceText{data.path.string() + ": sensor", data.text("sensor")});
  std::optional<JsonValue> json = parse_json(source, diagnostics);
  if (!json) return std::nullopt;
  require_one_conversion(overrides);
  for (const Override& o : overrides) {
    if (o.pointer != "/readout" && !o.pointer.starts_with("/readout/"))
      throw Error(
          ErrorCode::usage, "--set",
          fmt::format(
              "the render has already used this value (got {}, allowed /readout and keys below it, {})",
              o.pointer, kWhitePointer));
    replace_conversion(*json, o.pointer);
    set_json(*json, o.pointer, o.value, diagnostics, o.option_name);
  }
  sensor.description = overrides.empty() ? data.text("sensor") : to_text(*json);
  sensor.measured_camera = text_in(*json, "camera");
  sensor.camera = text_in(*json, "model");
  if (sensor.camera.empty()) sensor.camera = sensor.measured_camera;
  const JsonValue* readout = json->find("readout");
  if (readout == nullptr || diagnostics.has_errors()) return std::nullopt;
  if (sensor.planes.size() > sensor.channels.size() && !sensor.mosaic)
    throw Error(
        ErrorCode::input, data.path.string(),
        fmt::format("plane \"{}\" has signed values, not electrons to read out", sensor.planes.back()));
  for (const std::string& channel : sensor.channels)
    if (!data.text("channel." + channel).starts_with("quantum"))
      throw Error(ErrorCode::input, data.path.string(),
                  fmt::format("channel \"{}\" counts no electrons, so it cannot be read out", channel));
  return read_readout(*readout, data.find_number("electrons_per_lx_s"), diagnostics);
}

std::optional<WhiteField> read_white_field(const Metadata& data, const FilmSensor& sensor) {
  const auto text = data.find(kWhiteFieldKey);
  if (!text) return std::nullopt;
  std::optional<WhiteField> field = parse_white_field(*text, sensor.channels.size());
  if (!field || sensor.channels.size() != 3) data.refuse(kWhiteFieldKey);
  return field;
}

std::optional<DisplayTransform> read_display(const Metadata& data, FilmSensor& sensor,
                                             const ViewOptions& view, std::optional<Chromaticity> white) {
  const auto text = data.find("to_xyz_d65");
  if (!text) return std::nullopt;
  std::optional<Matrix3> matrix = parse_matrix3(*text);
  if (!matrix || (sensor.channels.size() != 1 && sensor.channels.size() != 3) ||
      (sensor.channels.size() == 3 && !is_invertible(*matrix)))
    data.refuse("to_xyz_d65");
  const std::string own_white = data.find(kWhiteKey).value_or("");
  if (auto calibrated = camera_matrix(view, sensor.channels, own_white, recorded_white(data.film))) {
    matrix = calibrated->to_xyz_d65;
    sensor.camera_space = std::move(calibrated->space);
  }
  if (white) {
    const auto own = recorded_white(data.film);
    if (!own)
      throw Error(ErrorCode::usage, kWhitePointer, "the film records no white that this could replace");
    const Matrix3 adapted = white_adaptation(*own);
    if (!is_invertible(adapted)) data.refuse(kWhiteXyKey);
    matrix = white_adaptation(*white) * adapted.inverse(true) * *matrix;
  }
  return DisplayTransform(sensor.channels, *matrix, view);
}

// Replaces the values of a plane, if the film has it, by a function of them.
template <typename F>
void map_plane(Image& film, const std::string& name, const F& f) {
  for (ImageChannel& channel : film.channels)
    if (channel.name == name)
      for (float& value : channel.values) value = static_cast<float>(f(static_cast<double>(value)));
}

// The sensor description, which was parsed before, so that errors are ignored.
std::optional<JsonValue> spec_of(const FilmSensor& sensor) {
  Diagnostics none;
  return parse_json(std::make_shared<const SourceText>(SourceText{"", sensor.description}), none);
}

double* number_in(JsonValue* spec, const char* key) {
  JsonValue* member = spec != nullptr ? spec->find(key) : nullptr;
  return member != nullptr ? std::get_if<double>(&member->value) : nullptr;
}

// Updates the exposure times in the description: of sensor, channels and shutter.
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

void set_exposure(ExposedFilm& exposed, double factor) {
  exposed.sensor.shared_exposure_s *= factor;
  for (double& seconds : exposed.sensor.exposure_s) seconds *= factor;
  describe_exposure(exposed.sensor, factor);
  record_exposure(exposed, factor);
}

// True if the transmission of the film's shutter varies during the exposure or between rows.
bool has_shaped_shutter(const FilmSensor& sensor) {
  const std::optional<JsonValue> spec = spec_of(sensor);
  const JsonValue* shutter = spec ? spec->find("shutter") : nullptr;
  constexpr std::array kShapes{"rise_s", "fall_s", "transmission", "row_delay_s"};
  return shutter != nullptr && std::ranges::any_of(kShapes, [&](const char* key) {
           const JsonValue* shape = shutter->find(key);
           const auto* number = shape != nullptr ? std::get_if<double>(&shape->value) : nullptr;
           return shape != nullptr && !(number != nullptr && *number == 0);
         });
}

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

std::optional<FilmSensor> read_film_sensor(const Image& film, const std::filesystem::path& path,
                                           std::span<const Override> overrides, const ViewOptions& view,
                                           std::optional<Chromaticity> white, Diagnostics& diagnostics) {
  const Metadata data{film, path};
  FilmSensor sensor;
  read_planes(data, sensor);
  sensor.gathering_area_m2 = data.number("gathering_area_m2");
  sensor.readout = read_readout_of(data, sensor, overrides, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  sensor.electrons_per_lx_s = data.find_number("electrons_per_lx_s");
  sensor.f_number = data.find_number("aperture");
  sensor.display = read_display(data, sensor, view, white);
  sensor.no_picture = data.find(kNoPictureKey).value_or("");
  sensor.white = white ? white : recorded_white(film);
  sensor.white_field = read_white_field(data, sensor);
  sensor.display_exposure = recorded_display_exposure(film, path);
  return sensor;
}

std::optional<double> recorded_display_exposure(const Image& film, const std::filesystem::path& path) {
  return Metadata{film, path}.find_number(kDisplayExposureKey);
}

std::optional<double> common_exposure(const FilmSensor& sensor) {
  const std::vector<double>& all = sensor.exposure_s;
  if (all.empty() || std::count(all.begin(), all.end(), all.front()) < std::ssize(all)) return std::nullopt;
  return all.front();
}

void require_display(const FilmSensor& sensor) {
  if (sensor.display) return;
  if (!sensor.no_picture.empty()) throw Error(ErrorCode::usage, "", sensor.no_picture);
  throw Error(ErrorCode::usage, "film",
              "a picture needs a sensor of one or three channels and a scene with a light");
}

void require_planes(const Image& film, const FilmSensor& sensor, const std::filesystem::path& path) {
  for (const std::string& plane : sensor.planes)
    for (const std::string& name : {plane, variance_of(plane)})
      if (film.find(name) == nullptr)
        throw Error(ErrorCode::input, path.string(), fmt::format("has no channel \"{}\"", name));
}

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
    map_plane(exposed.film, plane, [factor](double value) { return value * factor; });
    map_plane(exposed.film, variance_of(plane), [factor](double value) { return value * (factor * factor); });
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
    map_plane(exposed.film, plane, [light](double) { return light; });
    map_plane(exposed.film, variance_of(plane), [](double) { return 0; });
  }
  exposed.film.metadata[kFrameKey] = flat                                       ? kFlatFrame
                                     : std::holds_alternative<DarkFrame>(frame) ? "dark"
                                                                                : kBiasFrame;
  for (const char* key : {kFrameMeanErrorKey, kHalfNoiseSamplesKey}) exposed.film.metadata.erase(key);
  if (std::holds_alternative<BiasFrame>(frame)) set_exposure(exposed, 0);
}

}  // namespace abbe
