#include "results/film_attributes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calibration/output/display.h"
#include "develop/radiance.h"
#include "io/error.h"
#include "io/text.h"
#include "results/field_response.h"
#include "results/spectral.h"
#include "results/white.h"
#include "scene/colors.h"
#include "sensor/film/recorded_film_observer.h"
#include "sensor/film/recorded_white.h"
#include "sensor/film/variance_name.h"
#include "sensor/readout/demosaic.h"
#include "sensor/readout/speed.h"
#include "sensor/response/polariser_group.h"
#include "sensor/response/stokes_channels.h"
#include "transport/render/white.h"

namespace abbe {
namespace {

// Standard attributes of EXR files are in single precision.
std::string single(double x) {
  return fmt::format("{}", static_cast<float>(x));
}

// The sensor's exposure time if a channel has it, else that of all channels. Empty if channels have different
// ones, as behind a filter wheel.
std::optional<double> standard_exposure(const Scene& scene) {
  const auto count = [&scene](double ratio) {
    return static_cast<std::size_t>(
        std::count_if(scene.channels.begin(), scene.channels.end(),
                      [ratio](const Channel& c) { return c.exposure_ratio == ratio; }));
  };
  if (count(1) > 0) return scene.exposure_s;
  const double ratio = scene.channels.front().exposure_ratio;
  if (count(ratio) == scene.channels.size()) return scene.exposure_s * ratio;
  return std::nullopt;
}

// Records the sensitivity in daylight and, with a readout, the ISO speed.
void add_speed(const Scene& scene, double area_m2, FilmIdentity& identity) {
  const auto sensitivity = daylight_sensitivity(scene.channels, area_m2);
  if (!sensitivity) return;
  identity["electrons_per_lx_s"] = fmt::format("{}", *sensitivity);
  if (scene.readout) identity[kIsoSpeedKey] = single(saturation_speed(*scene.readout, *sensitivity));
}

// Records how pictures show the film, or why none can. A missing data table is not a property of the film.
void add_display(const Scene& scene, FilmIdentity& identity) {
  try {
    identity["to_xyz_d65"] = to_text(display_of(scene).to_xyz_d65());
  } catch (const Error& error) {
    if (error.code == ErrorCode::internal) throw;
    if (error.code == ErrorCode::usage) identity[kNoPictureKey] = error.what();
  }
}

// Adds the channels of a layer to those of the film.
void add_layer(Image& film, const std::string& name, Image layer) {
  const std::string variance = variance_of("");
  for (ImageChannel& channel : layer.channels) {
    const bool is_variance = channel.name.starts_with(variance);
    const std::string plane = is_variance ? channel.name.substr(variance.size()) : channel.name;
    const std::string of_layer = name + "." + plane;
    film.channels.push_back({is_variance ? variance_of(of_layer) : of_layer, std::move(channel.values)});
  }
}

const char* unit_of(ResponseKind kind) {
  switch (kind) {
    case ResponseKind::energy:
      return "energy, response-weighted J per m^2";
    case ResponseKind::quantum:
      return "quantum, electrons per m^2";
    case ResponseKind::photometric:
      return photometric_unit(Observer::cie1931);
    case ResponseKind::photometric_1964:
      return photometric_unit(Observer::cie1964);
  }
  throw Error(ErrorCode::internal, "", "unknown response kind");
}

}  // namespace

FilmIdentity film_attributes(const Scene& scene) {
  const double area_m2 = gathering_area(scene.camera.pixel_pitch, scene.fill_factor);
  FilmIdentity identity{{"sensor", scene.sensor_text},
                        {"exposure_s", fmt::format("{}", scene.exposure_s)},
                        {"gathering_area_m2", fmt::format("{}", area_m2)}};
  if (const auto seconds = standard_exposure(scene)) identity["expTime"] = single(*seconds);
  if (const auto n = traits(scene.camera).f_number) identity["aperture"] = single(*n);
  const std::vector<std::string> names = scene.channel_names();
  for (const Channel& channel : scene.channels) {
    if (channel.exposure_ratio != 1)
      identity["exposure_s." + channel.name] = fmt::format("{}", scene.exposure_s * channel.exposure_ratio);
    identity["channel." + channel.name] = unit_of(channel.kind);
  }
  const auto rows = polariser_rows(scene.channels);
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (rows[k]) identity[kAnalyserKey + names[k]] = to_text(*rows[k]);
  if (count_intensities(scene.channels) < scene.channels.size()) identity[kHandednessKey] = kRightHanded;
  identity["sensor_channels"] = fmt::format("{}", fmt::join(scene.film_planes(), ","));
  if (scene.mosaic) {
    identity["mosaic"] = to_text(*scene.mosaic, names);
    identity["mosaic_channels"] = fmt::format("{}", fmt::join(names, ","));
  }
  add_speed(scene, area_m2, identity);
  add_display(scene, identity);
  if (const auto field = white_field(scene)) identity[kWhiteFieldKey] = to_text(*field);
  add_white(scene, identity);
  if (const auto exposure = scene.output.display_exposure)
    identity[kDisplayExposureKey] = fmt::format("{}", *exposure);
  if (scene.spectral) add_spectral_identity(scene, identity);
  return identity;
}

DisplayTransform display_of(const Scene& scene, const ViewOptions& view) {
  if (scene.spectral) return display_of_radiance(view, white_of(scene).xy);
  const White white = has_colors(scene) ? white_of(scene) : White{"", "", {}, Curve(1.0)};
  const std::vector<Channel> channels = intensities(channels_at_center(scene));
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  if (const auto calibrated = camera_matrix(view, names, white.name, white.xy))
    return {std::move(names), calibrated->to_xyz_d65, {}, view};
  return make_display(channels, *white.spectrum, view, white.xy);
}

Image film_image(Image planes) {
  if (planes.metadata.contains(kSpectralBinsKey)) return spectral_film_image(planes);
  return planes;
}

Image film_image(const RenderPart& part) {
  Image image = film_image(image_of(part));
  for (auto& [name, layer] : layer_images(part)) add_layer(image, name, film_image(std::move(layer)));
  add_features(image, part);
  return image;
}

Image film_for_display(const Scene& scene, Image film) {
  erase_layer_and_feature_attributes(film.metadata);
  if (scene.mosaic) return demosaic(film, kRawPlane, *scene.mosaic, scene.channel_names());
  return film;
}

}  // namespace abbe
