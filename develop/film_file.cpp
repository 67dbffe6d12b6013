#include "develop/film_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "develop/radiance.h"
#include "develop/raw_picture.h"
#include "io/error.h"
#include "io/exr.h"
#include "io/picture.h"
#include "io/raw_picture.h"
#include "io/text.h"
#include "sensor/film/film_planes.h"

namespace abbe {
namespace {

constexpr const char* kExposurePart = "exposure";
constexpr const char* kVariancePart = "variance";

Image joined(std::vector<ExrPart> parts, const std::filesystem::path& path) {
  if (parts.size() == 1) return std::move(parts.front().image);
  Image film;
  for (ExrPart& part : parts) {
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

bool is_variance(const ImageChannel& channel) {
  return channel.name.starts_with(variance_of(""));
}

// Linear Rec.709 for displays, without the sensor attributes that would make it a film.
Image preview(const Image& planes, const Matrix3& to_xyz) {
  Image rgb = rec709_image(planes, to_xyz);
  erase_sensor_attributes(rgb.metadata);
  return rgb;
}

}  // namespace

void require_finite(const Image& film, const std::filesystem::path& path) {
  for (const ImageChannel& channel : film.channels)
    for (std::size_t i = 0; i < channel.values.size(); ++i)
      if (const float value = channel.values[i]; is_variance(channel) ? !(value >= 0) : !std::isfinite(value))
        throw Error(
            ErrorCode::input, path.string(),
            fmt::format(
                "channel \"{}\" has {} at pixel {},{} (got {})", channel.name,
                value < 0 && is_variance(channel) ? "a negative variance" : "a value that is not finite",
                i % static_cast<std::size_t>(film.width), i / static_cast<std::size_t>(film.width), value));
}

Image read_film(const std::filesystem::path& path, Inputs* inputs) {
  Image film = joined(read_exr_parts(path, inputs), path);
  require_finite(film, path);
  return film;
}

void write_parts(const std::filesystem::path& path, const DevelopedFilm& developed, const Image& planes,
                 const FilmSensor& sensor) {
  std::vector<ExrPart> parts{{kExposurePart, developed.exposure}, {kVariancePart, developed.variance}};
  if (sensor.readout) {
    parts.push_back({"electrons", developed.electrons});
    parts.push_back({"dn", developed.codes});
  }
  if (sensor.display) {
    const double white = display_white(sensor, planes);
    parts.push_back({"preview", preview(planes, sensor.display->to_xyz_d65() * (1 / white))});
  }
  write_exr(path, parts);
}

void write_display(const std::filesystem::path& path, const Image& planes, const FilmSensor& sensor) {
  const double white = display_white(sensor, planes);
  write_picture(path, (*sensor.display)(planes, 1 / white).image);
}

void require_developed_extension(const std::filesystem::path& path) {
  require_extension(path, {".exr", ".tif", ".tiff", ".png", ".dng", ".fits", ".fit"});
}

bool is_raw_file(const std::filesystem::path& path) {
  return extension_of(path) != ".exr";
}

void write_raw(const std::filesystem::path& path, const DevelopedFilm& developed, const FilmSensor& sensor) {
  if (extension_of(path) == ".dng") return write_dng(path, raw_picture(developed, sensor));
  if (is_raw_picture(path)) return write_fits(path, raw_picture(developed, sensor));
  Image raw{developed.codes.width, developed.codes.height, {}, developed.codes.metadata};
  for (const std::string& plane : sensor.planes) raw.channels.push_back(*developed.codes.find(plane));
  write_raw_picture(path, raw);
}

}  // namespace abbe
