#include "develop/polarisation.h"

#include <array>
#include <map>
#include <string>

#include <fmt/format.h>

#include "develop/radiance.h"
#include "io/error.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/film/spectral_film.h"
#include "sensor/readout/demosaic.h"
#include "sensor/response/polarised_channels.h"
#include "spectral/matrix3.h"

namespace abbe {
namespace {

std::vector<StokesPlanes> required_planes(const Image& film) {
  std::vector<StokesPlanes> planes = stokes_planes(film);
  if (planes.empty())
    throw Error(
        ErrorCode::usage, "--stokes",
        "the film does not measure polarisation: set sensor/stokes in the scene, or use polarisers at three "
        "sufficiently different angles");
  return planes;
}

// Luminance of radiances, with its Stokes components.
Image luminances(const Image& film) {
  const SpectralImage image = spectral_image(film, "film");
  const std::vector<Channel> observer = observer_channels(Observer::cie1931);
  return expose(image, with_stokes({observer.at(1)}), std::vector<double>(film.pixels(), 1.0));
}

// Luminance per unit of each channel; 1 if colours are unknown.
std::vector<double> weights_of(const Image& film, std::size_t channels) {
  const auto matrix = parse_matrix3(attribute_of(film.metadata, "to_xyz_d65").value_or(""));
  std::vector<double> weights(channels, 1.0);
  if (matrix && channels == 3)
    for (int k = 0; k < 3; ++k) weights[static_cast<std::size_t>(k)] = (*matrix)[1][k];
  return weights;
}

// A plane behind a polariser, with its row of the measurement matrix.
struct Measurement {
  PolariserRow row;
  const ImageChannel* plane;
};

std::map<std::string, std::vector<Measurement>> groups_of(const Image& planes,
                                                          const std::vector<std::string>& names) {
  std::map<std::string, std::vector<Measurement>> groups;
  for (const std::string& name : names) {
    const auto row = parse_polariser_row(attribute_of(planes.metadata, kAnalyserKey + name).value_or(""));
    const ImageChannel* plane = planes.find(name);
    if (row && plane != nullptr) groups[row->group].push_back({*row, plane});
  }
  return groups;
}

// The row r = (1, q, u): a plane's value is weight (I + q Q + u U).
std::array<double, 3> row_of(const Measurement& one) {
  return {1, one.row.q, one.row.u};
}

// Inverse of the sum of r r^T over the rows r; empty if they do not determine a Stokes vector.
std::optional<Matrix3> inverse_normal(const std::vector<Measurement>& group) {
  constexpr double kDetermined = 1e-3;  // three ideal polarisers at 0, 60 and 120 degrees give 27/4
  Matrix3 normal(0.0);
  for (const Measurement& one : group) {
    const auto row = row_of(one);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        normal[i][j] += row.at(static_cast<std::size_t>(i)) * row.at(static_cast<std::size_t>(j));
  }
  if (!(normal.determinant() > kDetermined)) return std::nullopt;
  return normal.inverse(true);
}

// Sum over the group of row * value at a pixel, in units of its first channel.
std::array<double, 3> projected(const std::vector<Measurement>& group, std::size_t pixel) {
  std::array<double, 3> sum{};
  for (const Measurement& one : group) {
    const double counted = static_cast<double>(one.plane->values[pixel]) / one.row.weight;
    const auto row = row_of(one);
    for (std::size_t i = 0; i < sum.size(); ++i) sum.at(i) += row.at(i) * counted;
  }
  return sum;
}

void add_stokes(const std::string& name, const std::vector<Measurement>& group, const Matrix3& solve,
                Image& stokes) {
  std::array<std::vector<float>, 3> planes;
  for (std::size_t pixel = 0; pixel < stokes.pixels(); ++pixel) {
    const std::array<double, 3> stokes_at_pixel = multiply(solve, projected(group, pixel));
    for (std::size_t i = 0; i < planes.size(); ++i)
      planes.at(i).push_back(static_cast<float>(stokes_at_pixel.at(i)));
  }
  for (int component = 0; component < 3; ++component)
    stokes.channels.push_back(
        {stokes_plane_name(component, name), std::move(planes.at(static_cast<std::size_t>(component)))});
}

}  // namespace

std::vector<PolarisationFigures> polarisation_of_light(const Image& film) {
  const std::vector<StokesPlanes> own = required_planes(film);
  const Image luminance = is_spectral(film) ? luminances(film) : Image{};
  const std::vector<StokesPlanes> planes = is_spectral(film) ? stokes_planes(luminance) : own;
  const std::vector<double> weights = weights_of(film, planes.size());
  std::vector<PolarisationFigures> all;
  all.reserve(film.pixels());
  for (std::size_t pixel = 0; pixel < film.pixels(); ++pixel) {
    StokesVector sum{};
    for (std::size_t k = 0; k < planes.size(); ++k)
      for (std::size_t i = 0; i < sum.size(); ++i) sum.at(i) += weights[k] * planes[k].at(pixel).at(i);
    all.push_back(polarisation_of(sum));
  }
  return all;
}

Image polarisation_image(const Image& film) {
  Image image{film.width, film.height, {}, film.metadata};
  erase_channel_attributes(image.metadata);
  erase_layout_attributes(image.metadata);
  erase_layer_and_feature_attributes(image.metadata);
  image.metadata.erase("sensor_channels");
  for (const StokesPlanes& planes : required_planes(film)) {
    ImageChannel degree{"DoP." + planes.channel, {}};
    ImageChannel linear{"DoLP." + planes.channel, {}};
    ImageChannel angle{"AoLP." + planes.channel, {}};
    for (std::size_t pixel = 0; pixel < film.pixels(); ++pixel) {
      const PolarisationFigures of = polarisation_of(planes.at(pixel));
      degree.values.push_back(static_cast<float>(of.degree));
      linear.values.push_back(static_cast<float>(of.linear_degree));
      angle.values.push_back(static_cast<float>(of.angle_deg));
    }
    if (planes.has_circular()) image.channels.push_back(std::move(degree));
    for (ImageChannel* channel : {&linear, &angle}) image.channels.push_back(std::move(*channel));
  }
  return image;
}

Image stokes_of_polarisers(const Image& film) {
  const auto mosaic = recorded_mosaic(film.metadata);
  const Image demosaiced = mosaic ? demosaic(film, kRawPlane, mosaic->pattern, mosaic->channels) : Image{};
  const Image& planes = mosaic ? demosaiced : film;
  Image stokes{film.width, film.height, {}, film.metadata};
  for (const auto& [name, group] : groups_of(planes, mosaic ? mosaic->channels : plane_names(film)))
    if (const auto solve = inverse_normal(group)) add_stokes(name, group, *solve, stokes);
  std::vector<std::string> names;
  for (const ImageChannel& channel : stokes.channels) names.push_back(channel.name);
  stokes.metadata["sensor_channels"] = fmt::format("{}", fmt::join(names, ","));
  for (const char* of_sensor : {"mosaic", "mosaic_channels", "to_xyz_d65", kNoPictureKey})
    stokes.metadata.erase(of_sensor);
  return stokes;
}

}  // namespace abbe
