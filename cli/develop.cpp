#include "cli/develop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include <fmt/format.h>

#include "calibration/output/color_spaces.h"
#include "calibration/output/white_clip.h"
#include "cli/answer.h"
#include "cli/film_output.h"
#include "cli/film_sensor.h"
#include "cli/output_files.h"
#include "cli/spectral.h"
#include "cli/white.h"
#include "io/atomic_file.h"
#include "io/exr.h"
#include "io/file_lock.h"
#include "io/picture.h"
#include "io/text.h"
#include "scene/description/white.h"
#include "sensor/film/recorded_white.h"
#include "sensor/readout/demosaic.h"
#include "sensor/readout/speed.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExposurePart = "exposure";
constexpr const char* kVariancePart = "variance";

bool is_exr(const fs::path& path) {
  return path.extension() == ".exr";
}

std::string variance_of(const std::string& plane) {
  return "Variance." + plane;
}

std::vector<fs::path> check_outputs(const DevelopOptions& options) {
  std::vector<fs::path> files = options.outputs;
  for (const fs::path& output : options.outputs) require_extension(output, {".exr", ".tif", ".tiff", ".png"});
  if (!options.display.empty()) {
    require_extension(options.display, {".png", ".jpg", ".tif"});
    files.push_back(options.display);
  }
  for (const fs::path& file : files) require_writable(file);
  require_distinct(files, std::array{options.film, options.scene});
  return files;
}

// A film as it was rendered, or one that was developed into parts before.
Image read_film(const fs::path& path, Inputs& inputs) {
  std::vector<ImagePart> parts = read_exr_parts(path, &inputs);
  if (parts.size() == 1) return std::move(parts.front().image);
  Image film;
  for (ImagePart& part : parts) {
    if (part.name != kExposurePart && part.name != kVariancePart) continue;
    if (part.name == kExposurePart) {
      film.width = part.image.width;
      film.height = part.image.height;
      film.metadata = std::move(part.image.metadata);
    }
    std::move(part.image.channels.begin(), part.image.channels.end(), std::back_inserter(film.channels));
  }
  if (film.pixels() == 0)
    throw Error(ErrorCode::input, path.string(), fmt::format("has no part \"{}\"", kExposurePart));
  return film;
}

void require_finite(const Image& film, const fs::path& path) {
  for (const ImageChannel& channel : film.channels)
    for (std::size_t i = 0; i < channel.values.size(); ++i)
      if (const float value = channel.values[i];
          !std::isfinite(value) || (value < 0 && channel.name.starts_with("Variance.")))
        throw Error(ErrorCode::input, path.string(),
                    fmt::format("channel \"{}\" holds no {} at pixel {},{} (got {})", channel.name,
                                std::isfinite(value) ? "variance" : "number",
                                i % static_cast<std::size_t>(film.width),
                                i / static_cast<std::size_t>(film.width), value));
}

void require_planes(const Image& film, const FilmSensor& sensor, const fs::path& path) {
  for (const std::string& plane : sensor.planes)
    for (const std::string& name : {plane, variance_of(plane)})
      if (film.find(name) == nullptr)
        throw Error(ErrorCode::input, path.string(), fmt::format("has no channel \"{}\"", name));
}

// What the picture is shown by; a user's configuration matters to nothing else.
ViewOptions view_of(const DevelopOptions& options) {
  return options.display.empty() ? ViewOptions{} : ViewOptions{users_configuration(), {}, {}};
}

/// A film and the sensor it was exposed on.
struct Exposed {
  Image film;
  FilmSensor sensor;
};

// The white asked for, the last of them, and what is left to ask for.
struct Asked {
  std::optional<std::string> white;
  std::vector<Override> others;
};
Asked asked(const DevelopOptions& options) {
  Asked all;
  for (const Override& o : options.overrides)
    if (o.pointer == kWhitePointer)
      all.white = o.value;
    else
      all.others.push_back(o);
  return all;
}

Exposed expose_spectral(Image file, const DevelopOptions& options, Inputs& inputs) {
  const auto [white, others] = asked(options);
  const Image told{0, 0, {}, file.metadata};
  const SpectralImage image = spectral_image(std::move(file), options.film.string());
  if (!options.scene.empty()) {
    Diagnostics diagnostics;
    std::optional<Scene> scene = load_scene(options.scene, {}, diagnostics, &inputs);
    if (!scene) check(diagnostics);  // warnings are about what nobody renders here
    settle_white(*scene, options.scene, told, white);
    Image film = seen_by(*scene, image, options.film);
    FilmSensor sensor = film_sensor(film, options.scene, others, view_of(options));
    require_planes(film, sensor, options.film);
    return {std::move(film), std::move(sensor)};
  }
  if (!options.outputs.empty())
    throw Error(ErrorCode::usage, "-o", "a spectral film needs a sensor that looks at it: --scene");
  FilmSensor sensor;
  sensor.planes = sensor.channels = {"R", "G", "B"};
  sensor.display = display_of_radiance(
      view_of(options), white ? std::optional(asked_white(*white, told)) : recorded_white(told));
  return {observed(image), std::move(sensor)};
}

Exposed load(const DevelopOptions& options, Inputs& inputs) {
  Image film = read_film(options.film, inputs);
  require_finite(film, options.film);
  if (is_spectral(film)) return expose_spectral(std::move(film), options, inputs);
  if (!options.scene.empty())
    throw Error(ErrorCode::usage, "--scene", "only a spectral film takes a sensor: this one has its own");
  const auto [white, others] = asked(options);
  const auto xy = white ? std::optional(asked_white(*white, film)) : std::nullopt;
  FilmSensor sensor = film_sensor(film, options.film, others, view_of(options), xy);
  require_planes(film, sensor, options.film);
  return {std::move(film), std::move(sensor)};
}

/// Planes of the film, one image for each step.
struct Developed {
  Image exposure;
  Image variance;
  Image electrons;   ///< Expected, from light; empty without a read-out, as the next.
  Image codes;       ///< And `Saturated.` planes.
  Image calibrated;  ///< What the codes say of the exposure; the exposure itself without a read-out.
};

Image like(const Image& film) {
  return {film.width, film.height, {}, film.metadata};
}

void read_plane(const Exposed& exposed, std::size_t plane, std::uint64_t seed, Developed& developed) {
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
    calibrated.values.push_back(static_cast<float>(
        (electrons_of(readout, dn) - readout.dark_e_per_s * seconds) / sensor.gathering_area_m2));
  developed.electrons.channels.push_back(std::move(electrons));
  developed.codes.channels.push_back({name, {raw.dn.begin(), raw.dn.end()}});
  developed.codes.channels.push_back({"Saturated." + name, {raw.saturated.begin(), raw.saturated.end()}});
  developed.calibrated.channels.push_back(std::move(calibrated));
}

Developed read_film_out(const Exposed& exposed, std::uint64_t seed) {
  const Image& film = exposed.film;
  Developed developed{like(film), like(film), like(film), like(film), like(film)};
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

// What a display is given: every channel in every pixel, and what saturated as white.
Image shown_planes(const FilmSensor& sensor, const Image& calibrated) {
  Image planes = sensor.mosaic ? demosaic(calibrated, sensor.planes.front(), *sensor.mosaic, sensor.channels)
                               : calibrated;
  if (!sensor.readout || !sensor.display || sensor.channels.size() != 3) return planes;
  const Readout& readout = *sensor.readout;
  const double full_e = std::min(readout.full_well_e, electrons_of(readout, readout.highest_code()));
  std::vector<double> saturation;
  for (std::size_t k = 0; k < 3; ++k) {
    const double seconds = sensor.exposure_s[std::min(k, sensor.planes.size() - 1)];
    saturation.push_back((full_e - readout.dark_e_per_s * seconds) / sensor.gathering_area_m2);
  }
  clip_to_white(planes, sensor.channels, sensor.display->to_xyz_d65(), saturation);
  return planes;
}

// Linear Rec.709 of the picture.
Image preview(const Image& planes, const DisplayTransform& display, double scale) {
  constexpr std::array kNames{"R", "G", "B"};
  const Matrix3 to_rgb = rgb_to_xyz(kRec709).inverse(true) * display.to_xyz_d65() * scale;
  Image picture = like(planes);
  for (int k = 0; k < 3; ++k) {
    ImageChannel& out =
        picture.channels.emplace_back(ImageChannel{kNames.at(static_cast<std::size_t>(k)), {}});
    out.values.assign(planes.pixels(), 0.0F);
    for (std::size_t j = 0; j < planes.channels.size(); ++j)
      for (std::size_t i = 0; i < planes.pixels(); ++i)
        out.values[i] += static_cast<float>(to_rgb[k][static_cast<int>(j)] * planes.channels[j].values[i]);
  }
  return picture;
}

void write_parts(const fs::path& path, const Developed& developed, const Image& planes,
                 const FilmSensor& sensor, std::optional<double> scale) {
  std::vector<ImagePart> parts{{kExposurePart, developed.exposure}, {kVariancePart, developed.variance}};
  if (sensor.readout) {
    parts.push_back({"electrons", developed.electrons});
    parts.push_back({"dn", developed.codes});
  }
  if (sensor.display)
    parts.push_back({"preview", preview(planes, *sensor.display,
                                        scale ? *scale : sensor.display->automatic_scale(planes))});
  write_exr(path, parts);
}

void write_raw(const fs::path& path, const Developed& developed) {
  Image raw = like(developed.codes);
  for (const ImageChannel& channel : developed.codes.channels)
    if (!channel.name.starts_with("Saturated.")) raw.channels.push_back(channel);
  write_raw_picture(path, raw);
}

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

// Errors as the roots of their mean squares over the pixels.
Json report(const Exposed& exposed, const Developed& developed) {
  const FilmSensor& sensor = exposed.sensor;
  Json answer;
  answer["planes"] = sensor.planes;
  if (!sensor.readout) {
    for (const ImageChannel& channel : developed.exposure.channels)
      answer["mean"].push_back(mean(channel.values));
    for (const ImageChannel& channel : developed.variance.channels)
      answer["render_error"].push_back(std::sqrt(mean(channel.values)));
    return answer;
  }
  for (std::size_t plane = 0; plane < sensor.planes.size(); ++plane) {
    const double mean_e = mean(developed.electrons.channels[plane].values);
    const TemporalNoise noise = temporal_noise(*sensor.readout, mean_e, sensor.exposure_s[plane]);
    answer["mean_e"].push_back(mean_e);
    answer["photon_noise_e"].push_back(noise.photon_e);
    answer["dark_noise_e"].push_back(noise.dark_e);
    answer["read_noise_e"].push_back(noise.read_e);
    answer["quantisation_noise_e"].push_back(noise.quantisation_e);
    answer["sensor_noise_e"].push_back(noise.total_e);
    answer["render_error_e"].push_back(std::sqrt(mean(developed.variance.channels[plane].values)) *
                                       sensor.gathering_area_m2);
    answer["saturated_share"].push_back(mean(developed.codes.channels[2 * plane + 1].values));
  }
  if (sensor.electrons_per_lx_s)
    answer["iso_speed"] = saturation_speed(*sensor.readout, *sensor.electrons_per_lx_s);
  return answer;
}

}  // namespace

int develop(const DevelopOptions& options) {
  const std::vector<fs::path> outputs = check_outputs(options);
  std::deque<FileLock> locks;
  for (const fs::path& file : outputs) locks.emplace_back(file);
  Inputs inputs(options.max_memory_bytes);
  const Exposed exposed = load(options, inputs);
  require_distinct(outputs, inputs.files());
  const FilmSensor& sensor = exposed.sensor;
  if (sensor.display) require_distinct(outputs, sensor.display->files());
  const bool wants_raw = std::any_of(options.outputs.begin(), options.outputs.end(),
                                     [](const fs::path& path) { return !is_exr(path); });
  if (wants_raw && !sensor.readout)
    throw Error(ErrorCode::usage, "-o",
                "the film has no read-out to make codes with (allowed: --set '/readout={...}', or a .exr)");
  if (!options.display.empty() && !sensor.display)
    throw Error(ErrorCode::usage, "--display",
                "a picture needs a sensor of one or three channels, and a light");

  const auto rendered = exposed.film.metadata.find("seed");
  const double render_seed =
      rendered == exposed.film.metadata.end() ? 0 : parse_number(rendered->second).value_or(0);
  // At most three planes beside each of the film and of its variance.
  inputs.take_memory("developing", 3 * exposed.film.memory_bytes());
  const Developed developed =
      read_film_out(exposed, options.seed.value_or(static_cast<std::uint64_t>(render_seed)));
  const Image planes = shown_planes(sensor, developed.calibrated);
  const std::optional<double> scale =
      sensor.display_exposure ? std::optional(1 / *sensor.display_exposure) : std::nullopt;
  for (const fs::path& output : options.outputs)
    if (is_exr(output))
      write_parts(output, developed, planes, sensor, scale);
    else
      write_raw(output, developed);
  if (!options.display.empty()) write_picture(options.display, (*sensor.display)(planes, scale).image);
  print(report(exposed, developed), options.json);
  return 0;
}

}  // namespace abbe::cli
