#include "sensor/film/feature_film.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/error.h"
#include "io/text.h"
#include "sensor/response/polarised_channels.h"

namespace abbe {
namespace {

constexpr int kUnitExponent = -60;

std::vector<std::string> planes_of(Feature feature, std::span<const std::string> film_planes) {
  static const std::map<Feature, std::vector<std::string>> kPlanes{
      {Feature::depth, {"depth.Z"}},
      {Feature::position, {"P.X", "P.Y", "P.Z"}},
      {Feature::normal, {"N.X", "N.Y", "N.Z"}},
      {Feature::shading_normal, {"Ns.X", "Ns.Y", "Ns.Z"}},
      {Feature::id, {"Id"}}};
  if (feature != Feature::albedo) return kPlanes.at(feature);
  std::vector<std::string> planes;
  for (const std::string& plane : intensities(film_planes)) planes.push_back("Albedo." + plane);
  return planes;
}

FilmShape feature_shape(const FilmShape& film, std::size_t planes) {
  return {.width = film.width,
          .height = film.height,
          .channels = static_cast<int>(planes),
          .replicates = 1,
          .unit_exponent = kUnitExponent,
          .crop = film.crop};
}

// Value of a feature in a pixel from the sum over its samples, `hits` of which hit a surface.
double pixel_value(std::optional<Feature> feature, double sum, double hits, double samples) {
  if (feature == Feature::id) return sum;
  const bool is_of_hits = feature == Feature::depth || feature == Feature::position;
  const double count = is_of_hits ? hits : samples;
  if (count > 0) return sum / count;
  return feature == Feature::depth ? static_cast<double>(kFeatureDepthOfNothing) : 0;
}

}  // namespace

std::string to_text(std::span<const Feature> features) {
  std::vector<const char*> words;
  for (const Feature feature : features) words.push_back(kFeatureNames.at(static_cast<std::size_t>(feature)));
  return fmt::format("{}", fmt::join(words, ","));
}

std::optional<std::vector<Feature>> parse_features(std::string_view text) {
  std::vector<Feature> features;
  for (const std::string& word : split(std::string(text), ',')) {
    const auto known = std::find(kFeatureNames.begin(), kFeatureNames.end(), word);
    if (known == kFeatureNames.end()) return std::nullopt;
    features.push_back(static_cast<Feature>(known - kFeatureNames.begin()));
  }
  std::sort(features.begin(), features.end());
  features.erase(std::unique(features.begin(), features.end()), features.end());
  return features;
}

std::vector<FeaturePlane> feature_planes(std::span<const Feature> features,
                                         std::span<const std::string> film_planes) {
  std::vector<FeaturePlane> planes{{"Coverage", std::nullopt}};
  for (const Feature feature : features)
    for (std::string& name : planes_of(feature, film_planes)) planes.push_back({std::move(name), feature});
  for (const FeaturePlane& plane : planes)
    if (std::find(film_planes.begin(), film_planes.end(), plane.name) != film_planes.end())
      throw Error(
          ErrorCode::scene, "sensor/channels",
          fmt::format("a channel has the name of a feature plane (got \"{}\"); rename it", plane.name));
  return planes;
}

FeatureFilm::FeatureFilm(std::vector<Feature> features, std::vector<FeaturePlane> planes, Film sums)
    : features_(std::move(features)), planes_(std::move(planes)), sums_(std::move(sums)) {}

FeatureFilm::FeatureFilm(std::vector<Feature> features, const FilmShape& film,
                         std::span<const std::string> film_planes)
    : features_(std::move(features)),
      planes_(feature_planes(features_, film_planes)),
      sums_(feature_shape(film, planes_.size())) {}

std::optional<FeatureFilm> FeatureFilm::from_bytes(std::vector<Feature> features, const FilmShape& film,
                                                   std::span<const std::string> film_planes,
                                                   std::string_view bytes) {
  std::vector<FeaturePlane> planes = feature_planes(features, film_planes);
  std::optional<Film> sums = Film::from_bytes(feature_shape(film, planes.size()), bytes);
  if (!sums) return std::nullopt;
  return FeatureFilm(std::move(features), std::move(planes), *std::move(sums));
}

void FeatureFilm::add(std::size_t pixel, std::span<const double> values) {
  if (std::all_of(values.begin(), values.end(), [this](double value) { return sums_.holds(value); }))
    sums_.add(pixel, 0, values);
}

void FeatureFilm::add_channels(Image& image) const {
  for (const FeaturePlane& plane : planes_)
    image.channels.push_back(
        {plane.name,
         std::vector<float>(image.pixels(), plane.feature == Feature::depth ? kFeatureDepthOfNothing : 0)});
}

void FeatureFilm::develop(Image& image, const Crop& area, double samples) const {
  const std::size_t first = image.channels.size() - planes_.size();
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    std::vector<float>& values = image.channels[first + i].values;
    for (int y = area.y0; y < area.y1; ++y)
      for (int x = area.x0; x < area.x1; ++x) {
        const std::size_t pixel = sums_.pixel_at(x, y);
        values[pixel] = static_cast<float>(pixel_value(
            planes_[i].feature, sums_.total(pixel, static_cast<int>(i)), sums_.total(pixel, 0), samples));
      }
  }
}

std::size_t bytes_of_features(std::span<const Feature> features, const FilmShape& film,
                              std::span<const std::string> film_planes) {
  if (features.empty()) return 0;
  return bytes_of_sums(feature_shape(film, feature_planes(features, film_planes).size()));
}

}  // namespace abbe
